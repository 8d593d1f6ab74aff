#include "core/continuation/branch.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "core/continuation/branch_node.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Arclengths in scaled unknowns: the first step, the longest and the shortest one, and the one down
// to which multipliers shorten the step.
constexpr double first_arc = 1e-3, longest_arc = 0.1, shortest_arc = 1e-10, watched_arc = 1e-6;
// Largest change of a multiplier in a step: near the unit circle, and in addition per distance from
// it.
constexpr double multiplier_step = 0.1, multiplier_step_away = 0.3;
// Cosine of the largest angle between neighbouring tangents, and that up to which steps grow.
constexpr double most_bend = 0.97, little_bend = 0.997;
constexpr double growth = 1.5;
// A parameter is at an end of its range if it is within this, in units of the range.
constexpr double at_end = 1e-12;
// Steps after which the section of a return is moved to the middle of a flight again.
constexpr int steps_of_section = 10;
// Steps back to the birth of a sticking phase are at most this multiple of the distance to where
// the ball did not stick.
constexpr double most_back = 1.5;
// Special points are bracketed to this arclength; the parameter changes less in it.
constexpr double special_arc = 1e-13;
// A branch is closed if its unknowns return to within this.
constexpr double same_unknowns = 1e-8;

struct BranchEvent {
    double h;  ///< arclength
    SpecialKind kind;
    BranchNode node;
};

OrbitCheck checked(const OrbitEquations& equations, const BranchNode& node) {
    return equations.check(node.at.z, node.approach);
}

OrbitPoint orbit_point(const OrbitEquations& equations, const BranchNode& node) {
    return orbit_point(equations, node.at.z, node.multipliers, checked(equations, node).measures);
}

/// Follows one direction of one branch.
class BranchFollower {
public:
    BranchFollower(
        const BranchPlan& plan, int number, Relative start, BranchSink& sink,
        std::function<void(SpecialKind, Relative)> branches_off)
        : plan_(plan),
          number_(number),
          on_(std::move(start)),
          origin_(on_->node.at),
          sink_(sink),
          branches_off_(std::move(branches_off)) {}

    bool is_loop = false;  ///< set by run(): the other direction is the same

    /// False if stopped.
    bool run() {
        sink_.point(number_, orbit_point(*on_->equations, on_->node));
        for (points_ = 1; points_ < plan_.most_points; ++points_) {
            if (plan_.stop && plan_.stop()) return false;
            if (const auto end = step()) return report_end(*end);
        }
        return report_end(BranchEnd::most_points);
    }

private:
    bool report_end(BranchEnd reason) {
        sink_.special(number_, {SpecialKind::end, orbit_point(*on_->equations, on_->node), reason});
        return true;
    }
    std::optional<BranchNode> after(double h) const {
        return node_after(*on_->equations, on_->node.at, h);
    }

    std::optional<BranchEnd> step();
    std::optional<BranchNode> node_at_end() const;
    std::optional<BranchNode> next_node();
    bool clip_to_range(std::optional<BranchNode>& b);
    OrbitCheck clip_to_existence(std::optional<BranchNode>& b);
    std::optional<BranchEvent> located(
        const BranchNode& b, SpecialKind kind,
        const std::function<double(const BranchNode&)>& test) const;
    std::optional<std::vector<BranchEvent>> events_before(const BranchNode& b) const;
    void report(const BranchEvent& event);
    std::optional<BranchEnd> pass_event(const SequenceFault& fault);
    bool pass_completion();
    bool move_section();
    bool is_closed() const;

    const BranchPlan& plan_;
    const int number_;
    std::optional<Relative> on_;
    const CurvePoint origin_;
    BranchSink& sink_;
    const std::function<void(SpecialKind, Relative)> branches_off_;
    double h_ = first_arc;
    long points_ = 0;
    int since_moved_ = 0;  // steps since move_section()
};

/// The sign change of a test between the current node and b, at the arclength h_; empty if it
/// cannot be located.
std::optional<BranchEvent> BranchFollower::located(
    const BranchNode& b, SpecialKind kind,
    const std::function<double(const BranchNode&)>& test) const {
    const auto test_at = [&](double h) -> std::optional<double> {
        const auto node = after(h);
        return node ? std::optional(test(*node)) : std::nullopt;
    };
    const auto h = sign_change(test_at, 0, test(on_->node), h_, test(b), special_arc);
    auto node = h ? after(*h) : std::nullopt;
    return node ? std::optional(BranchEvent{*h, kind, std::move(*node)}) : std::nullopt;
}

/// Special points between the current node and b, in order; empty if one cannot be located.
std::optional<std::vector<BranchEvent>> BranchFollower::events_before(const BranchNode& b) const {
    const BranchNode& a = on_->node;
    std::vector<BranchEvent> events;
    const auto locate = [&](double BranchNode::* test, SpecialKind kind) {
        if (std::signbit(a.*test) == std::signbit(b.*test) || a.*test == 0) return true;
        auto event = located(b, kind, test);
        if (!event) return false;
        // Two real multipliers with the product 1 change the sign, too.
        if (kind != SpecialKind::torus || event->node.unit_pair())
            events.push_back(std::move(*event));
        return true;
    };
    const bool mirrored = on_->equations->sequence().mirrored;
    if (!locate(&BranchNode::fold, SpecialKind::fold) ||
        !locate(
            &BranchNode::doubling, mirrored ? SpecialKind::symmetry_breaking : SpecialKind::flip) ||
        !locate(&BranchNode::torus, SpecialKind::torus))
        return std::nullopt;
    std::ranges::sort(events, {}, &BranchEvent::h);
    return events;
}

/// True if no multiplier moves far between a and b: special points of a kind can hide each other
/// within a step.
bool is_small_step(const BranchNode& a, const BranchNode& b) {
    return std::ranges::all_of(b.multipliers, [&](const auto& m) {
        double nearest = infinity;
        for (const auto& before : a.multipliers)
            nearest = std::min(nearest, elementary::modulus(m - before));
        const double away = std::abs(elementary::modulus(m) - 1);
        return nearest < multiplier_step + multiplier_step_away * away;
    });
}

/// The node at the end of the parameter's range if the step leads beyond, where there may be no
/// system.
std::optional<BranchNode> BranchFollower::node_at_end() const {
    const BranchNode& a = on_->node;
    const auto end = plan_.family.end_before(0, a.parameter() + h_ * a.fold);
    if (!end) return std::nullopt;
    return node_at_parameter(
        *on_->equations, a.at.z + (*end - a.parameter()) / a.fold * a.at.tangent, *end,
        a.fold > 0 ? 1 : -1);
}

/// Empty if Newton's method does not converge, however short the step.
std::optional<BranchNode> BranchFollower::next_node() {
    const BranchNode& a = on_->node;
    h_ = std::min({h_, longest_arc, plan_.resolution / std::abs(a.fold)});
    for (; h_ > shortest_arc; h_ *= 0.5) {
        auto b = after(h_);
        if (!b && (b = node_at_end())) h_ = a.at.tangent.dot(b->at.z - a.at.z);
        if (!b || !(b->at.tangent.dot(a.at.tangent) > most_bend)) continue;
        if (h_ > watched_arc && !is_small_step(a, *b)) continue;
        return b;
    }
    return std::nullopt;
}

/// Ends the step at the limit of the range if it goes beyond; true if so.
bool BranchFollower::clip_to_range(std::optional<BranchNode>& b) {
    const auto limit = plan_.family.end_before(0, b->parameter());
    if (!limit) return false;
    const int direction = b->parameter() > *limit ? 1 : -1;
    auto there = located(
        *b, SpecialKind::end, [&](const BranchNode& node) { return node.parameter() - *limit; });
    b.reset();
    if (!there) return true;
    h_ = there->h;
    b = node_at_parameter(*on_->equations, there->node.at.z, *limit, direction);
    if (!b) b = std::move(there->node);
    return true;
}

/// Ends the step where the orbit ceases to exist, if it does: the check then has the fault. Without
/// a node if that cannot be located.
OrbitCheck BranchFollower::clip_to_existence(std::optional<BranchNode>& b) {
    OrbitCheck found = checked(*on_->equations, *b);
    if (!found.fault) return found;
    double valid = 0, invalid = h_;
    b = on_->node;
    while (invalid - valid > special_arc) {
        const double middle = 0.5 * (valid + invalid);
        auto node = after(middle);
        // Beyond the loss of a sticking phase grazing contacts accumulate, where the return has no
        // derivative.
        if (!node && on_->node.is_return()) {
            invalid = middle;
            continue;
        }
        if (!node) {
            b.reset();
            return found;
        }
        const OrbitCheck here = checked(*on_->equations, *node);
        if (here.fault) invalid = middle, found = here;
        else valid = middle, b = std::move(node);
    }
    h_ = valid;
    return found;
}

void BranchFollower::report(const BranchEvent& e) {
    SpecialPoint special{e.kind, orbit_point(*on_->equations, e.node)};
    special.on = {on_->equations, e.node.at.z};
    if (e.kind == SpecialKind::torus) {
        auto m = *e.node.unit_pair();
        if (on_->equations->sequence().mirrored) m *= m;
        special.angle = std::abs(elementary::atan2(m.imag(), m.real()));
    }
    sink_.special(number_, special);
    if (e.kind != SpecialKind::flip && e.kind != SpecialKind::symmetry_breaking) return;
    if (auto other = doubled_branch(*on_->equations, e.node)) branches_off_(e.kind, *other);
}

/// Moves the section of a return away from events, which it reaches in the course of a branch.
/// False if the equations have none.
bool BranchFollower::move_section() {
    since_moved_ = 0;
    if (!on_->node.is_return()) return false;
    const auto moved = on_->equations->by_return(on_->node.at.z, on_->node.approach);
    if (!moved) return false;
    const int direction = on_->node.fold > 0 ? 1 : -1;
    auto node = node_at_parameter(*moved->equations, moved->z, on_->node.parameter(), direction);
    if (!node) return false;
    on_ = Relative{moved->equations, std::move(*node)};
    h_ = std::max(h_, first_arc);
    return true;
}

/// Where a chatter becomes complete, grazing contacts accumulate, each of which adds an impact.
/// Goes on beyond, where the ball sticks; false if there is no such orbit.
bool BranchFollower::pass_completion() {
    if (on_->node.is_return()) return false;
    auto beyond = beyond_by_return(*on_->equations, on_->node, true);
    if (!beyond) return false;
    // Back to where the sticking phase begins, which is before the present node.
    const double back = std::abs(beyond->node.parameter() - on_->node.parameter());
    Relative before = *std::exchange(on_, beyond);
    on_->node.at.tangent *= -1;
    h_ = most_back * back / std::abs(beyond->node.fold);
    auto birth = after(h_);
    const bool found = birth && clip_to_existence(birth).fault && birth;
    if (!found) {
        on_ = std::move(before);
        return false;
    }
    SpecialPoint stick{SpecialKind::stick, orbit_point(*on_->equations, *birth)};
    stick.on = {on_->equations, birth->at.z};
    sink_.special(number_, stick);
    on_ = std::move(beyond);
    sink_.point(number_, orbit_point(*on_->equations, on_->node));
    h_ = first_arc;
    return true;
}

std::optional<BranchEnd> BranchFollower::pass_event(const SequenceFault& fault) {
    const bool last =
        on_->equations->sequence().size() < 2 && fault.kind == SequenceFault::Kind::missing;
    SpecialPoint grazing{SpecialKind::grazing, orbit_point(*on_->equations, on_->node)};
    grazing.on = {on_->equations, on_->node.at.z};
    grazing.impact = fault.flight;
    if (fault.kind == SequenceFault::Kind::contact)
        if (auto changed = on_->equations->changed(on_->node.at.z, fault))
            grazing.on = std::move(*changed);
    const bool sticks = fault.kind == SequenceFault::Kind::stick;
    if (sticks) grazing.kind = SpecialKind::stick;
    else if (on_->node.is_return()) grazing.on = {};  // no equations hold at it
    auto beyond = beyond_event(*on_->equations, on_->node, fault);
    if (sticks && !on_->node.is_return() && beyond)
        grazing.on = {beyond->equations, beyond->node.at.z};
    if (beyond) grazing.impacts_after = beyond->equations->sequence().impacts();
    sink_.special(number_, grazing);
    const bool too_many = beyond && beyond->equations->sequence().size() > plan_.most_impacts;
    if ((too_many || (!beyond && !last && !sticks)) && pass_completion()) return std::nullopt;
    if (too_many) return BranchEnd::most_impacts;
    if (!beyond)
        return sticks ? BranchEnd::stick : last ? BranchEnd::last_impact : BranchEnd::grazing;
    on_.emplace(std::move(*beyond));
    sink_.point(number_, orbit_point(*on_->equations, on_->node));
    h_ = first_arc;
    if (repeats_itself(*on_->equations, on_->node.at.z)) return BranchEnd::parent;
    return std::nullopt;
}

/// True if the branch passes its first point again.
bool BranchFollower::is_closed() const {
    const Unknowns& z = on_->node.at.z;
    if (z.size() != origin_.z.size() || !((z - origin_.z).norm() < 2 * longest_arc)) return false;
    if (!(origin_.tangent.dot(z - origin_.z) > 0) || points_ < 5) return false;
    const auto there = point_in_plane(
        as_curve(*on_->equations), z, origin_.tangent, origin_.tangent.dot(origin_.z));
    return there && (there->z - origin_.z).norm() < same_unknowns && (z - origin_.z).norm() < h_;
}

std::optional<BranchEnd> BranchFollower::step() {
    const BranchNode& a = on_->node;
    if (plan_.family.end_before(0, a.parameter() + std::copysign(at_end, a.fold)))
        return BranchEnd::range;
    if (++since_moved_ > steps_of_section) move_section();
    auto b = next_node();
    if (!b && move_section()) b = next_node();
    if (!b) {
        if (pass_completion()) return std::nullopt;
        return BranchEnd::not_decided;
    }
    const bool turns = std::signbit(b->fold) != std::signbit(on_->node.fold);
    const double bend = b->at.tangent.dot(a.at.tangent);
    if (turns)
        if (auto parent = parent_orbit(*on_->equations, on_->node, 2 * h_)) {
            const bool mirrored = parent->equations->sequence().mirrored;
            on_.emplace(std::move(*parent));
            sink_.special(
                number_, {mirrored ? SpecialKind::symmetry_breaking : SpecialKind::flip,
                          orbit_point(*on_->equations, on_->node)});
            return BranchEnd::parent;
        }
    const bool leaves = clip_to_range(b);
    if (!b) return BranchEnd::not_decided;
    const OrbitCheck found = clip_to_existence(b);
    if (!b) return BranchEnd::not_decided;
    const auto events = events_before(*b);
    if (!events) return BranchEnd::not_decided;
    for (const BranchEvent& e : *events) report(e);
    on_->node = std::move(*b);
    if (found.fault) return pass_event(*found.fault);
    sink_.point(
        number_,
        orbit_point(*on_->equations, on_->node.at.z, on_->node.multipliers, found.measures));
    if (leaves) return BranchEnd::range;
    if (is_closed()) {
        is_loop = true;
        return BranchEnd::closed;
    }
    if (bend > little_bend) h_ *= growth;
    return std::nullopt;
}

}  // namespace

OrbitPoint orbit_point(
    const OrbitEquations& equations, const Unknowns& z, const Eigenvalues& eigenvalues,
    const OrbitMeasures& measures) {
    OrbitPoint point{equations.parameters(z), equations.sequence(), z, eigenvalues, measures};
    if (equations.sequence().mirrored)
        for (auto& m : point.multipliers) m *= m;
    return point;
}

const char* name_of(SpecialKind kind) {
    constexpr const char* names[] = {"fold",  "flip", "symmetry_breaking", "torus", "grazing",
                                     "stick", "end"};
    return names[static_cast<std::size_t>(kind)];
}

bool follow_branches(const BranchPlan& plan, const OrbitGuess& start, BranchSink& sink) {
    struct Open {
        BranchStart start;
        Relative at;
        int depth;
    };
    const double p = start.z(start.z.size() - 1);
    std::deque<Open> queue;
    int numbers = 0;
    for (const int direction : {1, -1})
        if (auto node = node_at_parameter(*start.equations, start.z, p, direction))
            queue.push_back(
                {{numbers++, -1, SpecialKind::end, direction},
                 {start.equations, std::move(*node)},
                 0});
    bool is_loop = false;  // then the other direction, number 1, is the same
    for (; !queue.empty(); queue.pop_front()) {
        if (is_loop && queue.front().start.number == 1) continue;
        const auto [begin, at, depth] = queue.front();
        sink.branch(begin);
        const auto branches_off = [&, from = begin.number, depth_ = depth](
                                      SpecialKind kind, Relative other) {
            if (depth_ >= plan.switches) return;
            const int direction = other.node.fold < 0 ? -1 : 1;
            queue.push_back({{numbers++, from, kind, direction}, std::move(other), depth_ + 1});
        };
        BranchFollower follower(plan, begin.number, at, sink, branches_off);
        if (!follower.run()) return false;
        if (begin.number == 0) is_loop = follower.is_loop;
    }
    return true;
}

}  // namespace vines
