#include "core/sweep/basins.hpp"

#include <cmath>

namespace vines {

namespace {

// Radii of neighbourhoods that are tested, in units of the motion, the number of random states on
// the surface of each, the factor by which these must approach the orbit, and that of the linear
// contraction in the time that they have for it: deviations can grow at first.
constexpr double tested_radii[] = {0.3, 0.1, 0.03, 0.01, 1e-3};
constexpr int tested_states = 192;
constexpr double least_approach = 0.01, contraction_in_test = 1e-4;
// A neighbourhood is smaller than the tested surface by this factor.
constexpr double within_tested = 0.5;
// Longest test, and periods beyond those of the linear contraction.
constexpr double most_tested_cycles = 4000, additional_periods = 20;
// z and x_rms of equal irregular motions agree to this fraction and to this many standard errors.
constexpr double same_statistics = 0.03, same_errors = 4;
// Starts that are measured to find the motions, for each value.
constexpr std::size_t explored_starts = 16;
// A box of starts that meets the cavity in less than this fraction is given up.
constexpr std::size_t most_tries_per_start = 100;
// Starts per cell of the entropy, and the fewest with which a cell counts.
constexpr double starts_per_cell = 25;
constexpr std::size_t fewest_per_cell = 10;
// The distances of pairs are 2^-first, ..., of the box. Those count for the exponent at which the
// uncertain fraction is below this part of that of two arbitrary starts.
constexpr int first_halving = 3, pair_distances = 10;
constexpr double below_saturation = 0.8;
constexpr double normal_95 = 1.96;
// Steps of a value are halved, down to this part, until Newton's method finds the orbit this near.
constexpr double least_part = 1.0 / 256, branch_reach = 0.1;

/// Radius of a neighbourhood from which motions approach the orbit.
double tested_radius(
    const Parameters& p, const PeriodicOrbit& orbit, const std::vector<State>& centres,
    const State& scale, const StopRequest& stop) {
    const double per_period = -elementary::log(elementary::modulus(orbit.multipliers[0])),
                 periods = std::ceil(
                     -elementary::log(contraction_in_test) / per_period + additional_periods);
    if (!(periods * orbit.cycles < most_tested_cycles)) return on_the_orbit;
    RandomSequence random(1);
    const auto approaches = [&](const State& centre, double radius) {
        Eigen::Vector4d v;
        for (double& component : v) component = uniform(random, -1, 1);
        v *= radius / v.cwiseAbs().maxCoeff();
        const State s = state_of(vector_of(centre) + v.cwiseProduct(vector_of(scale)));
        if (std::abs(s.x - s.y) > p.b) return true;  // no state
        const auto end = follow(p, s, 0, periods * orbit.cycles * p.cycle(), stop);
        return end && distance(*end, centre, scale) < least_approach * radius;
    };
    for (const double radius : tested_radii) {
        int passed = 0;
        while (passed < tested_states &&
               approaches(centres[static_cast<std::size_t>(passed) % centres.size()], radius))
            ++passed;
        if (passed == tested_states) return within_tested * radius;
    }
    return on_the_orbit;
}

bool has_same_statistics(const PointResult& one, const PointResult& other) {
    const auto agree = [](double a, double error_a, double b, double error_b) {
        const double error = std::isfinite(error_a + error_b) ? error_a + error_b : 0;
        return std::abs(a - b) < same_errors * error + same_statistics * std::max(a, b);
    };
    return agree(one.regime.z, one.regime.z_error, other.regime.z, other.regime.z_error) &&
           agree(one.x_rms, one.x_rms_error, other.x_rms, other.x_rms_error);
}

/// Number of components that vary in a box.
long dimensions_of(const StartBox& box) {
    return std::ranges::count_if(box, [](const Interval& i) { return i.from != i.to; });
}

/// Mean and its standard error; empty without values.
std::optional<Estimate> mean_of(const std::vector<double>& values) {
    if (values.empty()) return std::nullopt;
    const double n = static_cast<double>(values.size());
    double mean = 0, squares = 0;
    for (const double v : values) mean += v / n;
    for (const double v : values) squares += (v - mean) * (v - mean);
    return Estimate{mean, values.size() > 1 ? std::sqrt(squares / (n - 1) / n) : nan};
}

/// Slope of a weighted straight line; its error is that of the weights, or of a larger scatter.
Estimate slope_of(
    const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& weight) {
    double w = 0, wx = 0, wy = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        w += weight[i], wx += weight[i] * x[i], wy += weight[i] * y[i];
    double xx = 0, xy = 0, residual = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += weight[i] * (x[i] - wx / w) * (x[i] - wx / w);
        xy += weight[i] * (x[i] - wx / w) * (y[i] - wy / w);
    }
    const double slope = xy / xx;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double off = y[i] - wy / w - slope * (x[i] - wx / w);
        residual += weight[i] * off * off;
    }
    const double freedom = static_cast<double>(x.size()) - 2;
    return {slope, std::sqrt(std::max(1.0, residual / freedom) / xx)};
}

/// The same orbit at another value; empty if it is lost on the way.
std::optional<PeriodicOrbit> continued(
    const BasinPlan& plan, const PeriodicOrbit& from, double a, double b) {
    PeriodicOrbit orbit = from;
    auto before = plan.system_at(a);
    for (double part = 0, step = 1; part < 1;) {
        const double next = std::min(1.0, part + step);
        const auto system = plan.system_at(a + next * (b - a));
        if (!system || !before) return std::nullopt;
        const Parameters& p = system->parameters;
        const std::vector<State> states = whole_cycle_states(before->parameters, orbit);
        const State guess = carried(states.back(), before->parameters, p);
        const auto found = find_orbit(p, guess, from.cycles, scale_of(p, states), branch_reach, {});
        if (found && found->cycles == from.cycles) {
            orbit = *found, before = system, part = next;
            step *= 2;
        } else if ((step *= 0.5) < least_part) {
            return std::nullopt;
        }
    }
    return orbit;
}

bool is_chaotic(const PointResult& r) { return r.name.motion.starts_with("chaotic"); }

}  // namespace

KnownMotions::KnownMotions(
    const Parameters& p, const std::vector<PointResult>& motions, const StopRequest& stop)
    : parameters_(p) {
    std::vector<std::string> names;
    for (const PointResult& m : motions) {
        if (!m.measured || std::ranges::find(names, m.name.motion) != names.end()) continue;
        if (!m.regime.orbit || m.regime.orbit->contacts == 0) {
            if (is_chaotic(m) && std::ranges::any_of(others_, [&](const PointResult& other) {
                    return is_chaotic(other) && has_same_statistics(m, other);
                }))
                continue;
            others_.push_back(m);
        } else {
            const std::vector<State> centres = whole_cycle_states(p, *m.regime.orbit);
            const State scale = scale_of(p, centres);
            orbits_.push_back(
                {centres, scale, tested_radius(p, *m.regime.orbit, centres, scale, stop), m});
        }
        names.push_back(m.name.motion);
    }
}

const PointResult* KnownMotions::reached_from(const State& s) const {
    for (const Neighbourhood& n : orbits_)
        for (const State& centre : n.centres)
            if (std::abs(s.x - centre.x) < n.radius * n.scale.x &&
                distance(s, centre, n.scale) < n.radius)
                return &n.motion;
    if (s.y_dot != 0) return nullptr;
    for (const PointResult& m : others_)
        if (m.name.motion == "untouched" && is_never_touched(parameters_, s)) return &m;
    return nullptr;
}

void KnownMotions::name_as_known(PointResult& motion) const {
    if (!is_chaotic(motion)) return;
    for (const PointResult& m : others_)
        if (is_chaotic(m) && has_same_statistics(m, motion)) motion.name = m.name;
}

std::vector<State> starts_in(
    const StartBox& box, const Parameters& p, std::size_t count, std::uint64_t seed) {
    // 1/(positive root of x^(d + 1) = x + 1) for d = 1, ..., 4; the recurrence adds its powers.
    constexpr double steps[] = {
        0.6180339887498949, 0.7548776662466927, 0.8191725133961645, 0.8566748838545029};
    const long varied = dimensions_of(box);
    RandomSequence random(seed);
    std::array<double, 4> at{}, step{};
    double power = 1;
    for (int i = 0; i < 4; ++i) {
        at[i] = uniform(random, 0, 1);
        if (box[i].from != box[i].to) step[i] = power *= steps[varied - 1];
    }
    std::vector<State> starts;
    for (std::size_t tries = 0;
         starts.size() < count && tries < most_tries_per_start * (starts.size() + 1); ++tries) {
        Eigen::Vector4d v;
        for (int i = 0; i < 4; ++i) {
            v(i) = box[i].from + at[i] * (box[i].to - box[i].from);
            at[i] += step[i];
            if (at[i] >= 1) at[i] -= 1;
        }
        const State s = state_of(v);
        if (std::abs(s.x - s.y) <= p.b) starts.push_back(s);
    }
    return starts;
}

Basins::Basins(BasinPlan plan, const std::function<void()>& poll) : plan_(std::move(plan)) {
    for (std::size_t i = 0; i < values(); ++i) {
        poll();
        systems_.push_back(*plan_.system_at(plan_.values[i]));
        starts_.push_back(
            starts_in(plan_.boxes[i], systems_.back().parameters, plan_.count, plan_.seed));
    }
    labels_.resize(plan_.count * values());
}

std::optional<PointSystem> Basins::system_of(const Place& place) const {
    const std::size_t value = place.at.empty() ? 0 : place.at[0];
    if (place.start >= starts_[value].size()) return std::nullopt;
    PointSystem system = systems_[value];
    system.start = starts_[value][place.start];
    return system;
}

void Basins::explore(int threads, const PointOptions& options, RunControl& control) {
    const std::size_t each = std::min(explored_starts, plan_.count);
    std::vector<PointResult> found(each * values());
    parallel(found.size(), threads, &control, [&](std::size_t i) {
        const auto system = system_of({i % each, {i / each}});
        if (system) found[i] = run_point(*system, system->start, options, control);
        else poll(control);
    });
    parallel(values(), threads, &control, [&](std::size_t value) {
        const auto stop = [&control] { return control.stop_or_yield(); };
        const auto first = found.begin() + static_cast<std::ptrdiff_t>(value * each);
        systems_[value].known = std::make_shared<const KnownMotions>(
            systems_[value].parameters,
            std::vector<PointResult>(first, first + static_cast<std::ptrdiff_t>(each)), stop);
        if (stop()) throw Stopped();
    });
}

void Basins::add(std::size_t line, const PointResult& result) {
    const std::lock_guard lock(mutex_);
    const auto [at, is_new] =
        index_of_.try_emplace({line % values(), result.name.motion}, motions_.size() + 1);
    labels_[line] = at->second;
    if (is_new) motions_.push_back({line, result});
    else if (line < motions_[at->second - 1].line) motions_[at->second - 1] = {line, result};
}

bool Basins::restore(std::size_t line, const std::string& name) {
    const std::lock_guard lock(mutex_);
    const auto [at, is_new] = index_of_.try_emplace({line % values(), name}, motions_.size() + 1);
    if (is_new) motions_.push_back({labels_.size(), {}});
    else labels_[line] = at->second;
    return !is_new;
}

bool Basins::is_complete() const {
    const std::lock_guard lock(mutex_);
    return std::ranges::find(labels_, std::size_t{0}) == labels_.end();
}

void Basins::run_pairs(int threads, const PointOptions& options, RunControl& control) {
    RandomSequence random(plan_.seed + 1);
    struct Neighbour {
        std::size_t line;
        int distance;
        State start;
    };
    std::vector<Neighbour> all;
    for (std::size_t value = 0; value < values(); ++value)
        for (int distance = 0; distance < pair_distances; ++distance)
            for (std::size_t i = 0; i < std::min(plan_.pairs, starts_[value].size()); ++i) {
                Eigen::Vector4d v = vector_of(starts_[value][i]);
                bool inside = true;
                for (int k = 0; k < 4; ++k) {
                    const auto& [from, to] = plan_.boxes[value][k];
                    v(k) += std::ldexp(
                        uniform(random, 0, 1) < 0.5 ? from - to : to - from,
                        -first_halving - distance);
                    inside = inside && v(k) >= from && v(k) <= to;
                }
                const State s = state_of(v);
                if (inside && std::abs(s.x - s.y) <= systems_[value].parameters.b)
                    all.push_back({i * values() + value, distance, s});
            }
    parallel(all.size(), threads, &control, [&](std::size_t i) {
        const Neighbour& n = all[i];
        const PointResult there = run_point(systems_[n.line % values()], n.start, options, control);
        const std::lock_guard lock(mutex_);
        const PointResult& here = motions_[labels_[n.line] - 1].motion;
        if (there.name.motion == "not_decided" || here.name.motion == "not_decided") return;
        pairs_.push_back({n.line, n.distance, there.name.motion != here.name.motion});
    });
}

Interval binomial_interval(double k, double n) {
    const double z2 = normal_95 * normal_95, middle = (k + 0.5 * z2) / (n + z2),
                 half = normal_95 / (n + z2) * std::sqrt(k * (n - k) / n + 0.25 * z2);
    return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

void Basins::add_entropy(std::size_t value, BasinsAt& at) const {
    const long varied = dimensions_of(plan_.boxes[0]);
    const auto per_side = static_cast<int>(std::max(
        1.0,
        std::floor(elementary::pow(
            static_cast<double>(at.starts) / starts_per_cell, 1 / static_cast<double>(varied)))));
    std::map<std::array<int, 4>, std::map<std::string, std::size_t>> cells;
    for (std::size_t i = 0; i < starts_[value].size(); ++i) {
        const std::size_t label = labels_[i * values() + value];
        if (label == 0) continue;
        const std::string& name = motions_[label - 1].motion.name.motion;
        if (name == "not_decided") continue;
        const Eigen::Vector4d v = vector_of(starts_[value][i]);
        std::array<int, 4> cell{};
        for (int k = 0; k < 4; ++k) {
            const auto& [from, to] = plan_.boxes[value][k];
            if (from != to)
                cell[k] = std::min(
                    per_side - 1, static_cast<int>((v(k) - from) / (to - from) * per_side));
        }
        ++cells[cell][name];
    }
    std::vector<double> entropies, at_boundary;
    for (const auto& [cell, counts] : cells) {
        double all = 0, sum = 0;
        for (const auto& [name, n] : counts) all += static_cast<double>(n);
        if (all < fewest_per_cell) continue;
        for (const auto& [name, n] : counts)
            sum -= static_cast<double>(n) / all * elementary::log(static_cast<double>(n) / all);
        entropies.push_back(sum);
        if (counts.size() > 1) at_boundary.push_back(sum);
    }
    at.cells = entropies.size();
    at.entropy = mean_of(entropies);
    at.boundary_entropy = mean_of(at_boundary);
}

void Basins::add_exponent(std::size_t value, BasinsAt& at) const {
    double arbitrary = 1;
    for (const Basin& basin : at.basins) arbitrary -= basin.fraction * basin.fraction;
    std::vector<double> x, y, weight;
    for (int k = 0; k < pair_distances; ++k) {
        double all = 0, differ = 0;
        for (const Pair& pair : pairs_) {
            if (pair.line % values() != value || pair.distance != k) continue;
            ++all;
            differ += pair.differs;
        }
        if (all == 0) continue;
        at.distances.push_back(std::ldexp(1, -first_halving - k));
        at.uncertain.push_back(differ / all);
        if (differ == 0 || differ > below_saturation * arbitrary * all) continue;
        x.push_back(elementary::log(at.distances.back()));
        y.push_back(elementary::log(differ / all));
        weight.push_back(differ / (1 - differ / all));
    }
    if (x.size() > 2) at.uncertainty_exponent = slope_of(x, y, weight);
}

BasinsAt Basins::basins_at(std::size_t value) const {
    BasinsAt at{};
    at.value = plan_.values[value];
    std::map<std::size_t, std::size_t> counts;
    for (std::size_t line = value; line < labels_.size(); line += values())
        if (labels_[line] > 0) ++at.starts, ++counts[labels_[line]];
    const auto all = static_cast<double>(at.starts);
    for (const auto& [label, n] : counts) {
        const PointResult& motion = motions_[label - 1].motion;
        if (motion.name.motion == "not_decided") {
            at.not_decided = n;
            continue;
        }
        const auto k = static_cast<double>(n);
        at.basins.push_back({motion, n, k / all, binomial_interval(k, all), std::nullopt});
    }
    std::ranges::stable_sort(at.basins, [](const Basin& one, const Basin& other) {
        return std::pair(other.starts, one.motion.name.motion) <
               std::pair(one.starts, other.motion.name.motion);
    });
    if (at.starts > 0) add_entropy(value, at);
    add_exponent(value, at);
    return at;
}

std::vector<BasinsAt> Basins::result() const {
    std::vector<BasinsAt> all;
    // Orbits that are followed from value to value by the numbers of their branches, until lost.
    std::map<int, PeriodicOrbit> open;
    int numbers = 0;
    for (std::size_t value = 0; value < values(); ++value) {
        all.push_back(basins_at(value));
        std::map<std::string, int> number_of;
        std::map<int, PeriodicOrbit> still_open;
        for (const auto& [number, orbit] : open)
            if (const auto here =
                    continued(plan_, orbit, plan_.values[value - 1], plan_.values[value])) {
                number_of.try_emplace(
                    name_of(systems_[value].parameters, *here, {}).motion, number);
                still_open.emplace(number, *here);
            }
        for (Basin& basin : all.back().basins) {
            if (!basin.motion.regime.orbit) continue;
            const auto [known, is_new] = number_of.try_emplace(basin.motion.name.motion, numbers);
            basin.branch = known->second;
            if (!is_new) continue;
            ++numbers;
            still_open.emplace(*basin.branch, *basin.motion.regime.orbit);
        }
        open = std::move(still_open);
    }
    return all;
}

}  // namespace vines
