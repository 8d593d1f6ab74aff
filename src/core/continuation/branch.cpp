#include "core/continuation/branch.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "core/continuation/branch_node.hpp"

namespace vines {

namespace {

// Arclengths in scaled unknowns: the first step, the longest and the shortest one, and the one down
// to which multipliers shorten the step.
constexpr double first_arc = 1e-3, longest_arc = 0.1, shortest_arc = 1e-10, watched_arc = 1e-6;
// Largest change of a multiplier in a step: on the unit circle, and more per distance from it.
constexpr double multiplier_step = 0.1, multiplier_step_away = 0.3;
// Cosine of the largest angle between neighbouring tangents, and that up to which steps grow.
constexpr double most_bend = 0.97, little_bend = 0.997;
constexpr double growth = 1.5;
// A parameter is at an end of its range if it is within this, in units of the range.
constexpr double at_end = 1e-12;
// Steps after which the section of a return is moved to the middle of a flight again.
constexpr int steps_of_section = 10;
// Largest change of an orbit's unknowns there; another orbit is farther.
constexpr double moved_unknowns = 1e-4;
// Largest step back to the birth of a sticking phase, over the distance to where none was.
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

OrbitPoint orbit_point(const BranchNode& node) {
    return orbit_point(*node.equations, node.at.z, node.multipliers, node.check().measures);
}

/// Kind of the special point at which a multiplier of a node is -1.
SpecialKind kind_of_doubling(const BranchNode& node) {
    return node.equations->sequence().mirrored ? SpecialKind::symmetry_breaking : SpecialKind::flip;
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

/// Follows one direction of one branch.
class BranchFollower {
public:
    BranchFollower(
        const BranchPlan& plan, int number, const BranchNode& start, BranchSink& sink,
        std::function<void(SpecialKind, const BranchNode&)> branches_off)
        : plan_(plan),
          number_(number),
          on_(start),
          origin_(start.at),
          sink_(sink),
          branches_off_(std::move(branches_off)) {}

    bool is_loop = false;  ///< set by run(): the other direction is the same

    /// False if stopped.
    bool run() {
        sink_.point(number_, orbit_point(on_));
        for (points_ = 1; points_ < plan_.most_points; ++points_) {
            if (plan_.stop && plan_.stop()) return false;
            if (const auto end = step()) return report_end(*end);
        }
        return report_end(BranchEnd::most_points);
    }

private:
    bool report_end(BranchEnd reason) {
        sink_.special(number_, {SpecialKind::end, orbit_point(on_), reason});
        return true;
    }

    std::optional<BranchEnd> step() {
        if (plan_.family.end_before(0, on_.parameter() + std::copysign(at_end, on_.fold)))
            return BranchEnd::range;
        if (++since_moved_ > steps_of_section) move_section();
        auto b = next_node();
        if (!b && move_section()) b = next_node();
        if (!b) {
            if (pass_completion()) return std::nullopt;
            return BranchEnd::not_decided;
        }
        const bool turns = std::signbit(b->fold) != std::signbit(on_.fold);
        const double bend = b->at.tangent.dot(on_.at.tangent);
        if (turns)
            if (auto parent = parent_orbit(on_, 2 * h_)) {
                on_ = std::move(*parent);
                sink_.special(number_, {kind_of_doubling(on_), orbit_point(on_)});
                return BranchEnd::parent;
            }
        const bool leaves = clip_to_range(b);
        if (!b) return BranchEnd::not_decided;
        const OrbitCheck found = clip_to_existence(b);
        if (!b) return BranchEnd::not_decided;
        const auto events = events_before(*b);
        if (!events) return BranchEnd::not_decided;
        for (const BranchEvent& e : *events) report(e);
        on_ = std::move(*b);
        if (found.fault) return pass_event(*found.fault);
        sink_.point(
            number_, orbit_point(*on_.equations, on_.at.z, on_.multipliers, found.measures));
        if (leaves) return BranchEnd::range;
        if (is_closed()) {
            is_loop = true;
            return BranchEnd::closed;
        }
        if (bend > little_bend) h_ *= growth;
        return std::nullopt;
    }

    /// Empty if Newton's method does not converge, however short the step.
    std::optional<BranchNode> next_node() {
        h_ = std::min({h_, longest_arc, plan_.resolution / std::abs(on_.fold)});
        for (; h_ > shortest_arc; h_ *= 0.5) {
            auto b = on_.after(h_);
            if (!b && (b = node_at_end())) h_ = on_.at.tangent.dot(b->at.z - on_.at.z);
            if (!b || !(b->at.tangent.dot(on_.at.tangent) > most_bend || is_corner(*b))) continue;
            if (h_ > watched_arc && !is_small_step(on_, *b)) continue;
            return b;
        }
        return std::nullopt;
    }

    /// True if the branch of a return has an edge before b, as where slips come or go: the tangents
    /// differ, however short the step.
    bool is_corner(const BranchNode& b) const {
        return h_ <= watched_arc && on_.is_return() && (b.at.z - on_.at.z).norm() < most_back * h_;
    }

    /// The node at the end of the parameter's range if the step leads beyond.
    std::optional<BranchNode> node_at_end() const {
        const auto end = plan_.family.end_before(0, on_.parameter() + h_ * on_.fold);
        if (!end) return std::nullopt;
        const Unknowns z = on_.at.z + (*end - on_.parameter()) / on_.fold * on_.at.tangent;
        return node_at_parameter({on_.equations, z}, *end, on_.fold > 0 ? 1 : -1);
    }

    /// Ends the step at the limit of the range if it goes beyond; true if so.
    bool clip_to_range(std::optional<BranchNode>& b) {
        const auto limit = plan_.family.end_before(0, b->parameter());
        if (!limit) return false;
        const int direction = b->parameter() > *limit ? 1 : -1;
        auto there = located(*b, SpecialKind::end, [&](const BranchNode& node) {
            return node.parameter() - *limit;
        });
        b.reset();
        if (!there) return true;
        h_ = there->h;
        b = node_at_parameter(there->node.guess(), *limit, direction);
        if (!b) b = std::move(there->node);
        return true;
    }

    /// Ends the step where the orbit ceases to exist, if it does: the check then has the fault.
    /// Without a node if that cannot be located.
    OrbitCheck clip_to_existence(std::optional<BranchNode>& b) {
        OrbitCheck found = b->check();
        if (!found.fault) return found;
        double valid = 0, invalid = h_;
        b = on_;
        while (invalid - valid > special_arc) {
            const double middle = 0.5 * (valid + invalid);
            auto node = on_.after(middle);
            // Grazing contacts accumulate beyond a loss of sticking: no derivative.
            if (!node && on_.is_return()) {
                invalid = middle;
                continue;
            }
            if (!node) {
                b.reset();
                return found;
            }
            const OrbitCheck here = node->check();
            if (here.fault) invalid = middle, found = here;
            else valid = middle, b = std::move(node);
        }
        h_ = valid;
        return found;
    }

    /// The sign change of a test between the current node and b, at h_; empty if it is not found.
    std::optional<BranchEvent> located(
        const BranchNode& b, SpecialKind kind,
        const std::function<double(const BranchNode&)>& test) const {
        const auto test_at = [&](double h) -> std::optional<double> {
            const auto node = on_.after(h);
            return node ? std::optional(test(*node)) : std::nullopt;
        };
        const auto h = sign_change(test_at, 0, test(on_), h_, test(b), special_arc);
        auto node = h ? on_.after(*h) : std::nullopt;
        return node ? std::optional(BranchEvent{*h, kind, std::move(*node)}) : std::nullopt;
    }

    /// Special points between the current node and b, in order; empty if one cannot be located.
    std::optional<std::vector<BranchEvent>> events_before(const BranchNode& b) const {
        const std::pair<double BranchNode::*, SpecialKind> tests[] = {
            {&BranchNode::fold, SpecialKind::fold},
            {&BranchNode::doubling, kind_of_doubling(on_)},
            {&BranchNode::torus, SpecialKind::torus}};
        std::vector<BranchEvent> events;
        for (const auto& [test, kind] : tests) {
            if (std::signbit(on_.*test) == std::signbit(b.*test) || on_.*test == 0) continue;
            auto event = located(b, kind, test);
            if (!event) return std::nullopt;
            // Two real multipliers with the product 1 change the sign, too.
            if (kind != SpecialKind::torus || event->node.unit_pair())
                events.push_back(std::move(*event));
        }
        std::ranges::sort(events, {}, &BranchEvent::h);
        return events;
    }

    void report(const BranchEvent& e) {
        SpecialPoint special{e.kind, orbit_point(e.node)};
        special.on = e.node.guess();
        if (e.kind == SpecialKind::torus) {
            auto m = *e.node.unit_pair();
            if (on_.equations->sequence().mirrored) m *= m;
            special.angle = std::abs(elementary::atan2(m.imag(), m.real()));
        }
        sink_.special(number_, special);
        if (e.kind != SpecialKind::flip && e.kind != SpecialKind::symmetry_breaking) return;
        if (const auto other = doubled_branch(e.node)) branches_off_(e.kind, *other);
    }

    /// Moves the section of a return away from events, which it reaches in the course of a branch.
    /// False if the equations have none.
    bool move_section() {
        since_moved_ = 0;
        if (!on_.is_return()) return false;
        const auto moved = on_.equations->by_return(on_.at.z, on_.approach);
        if (!moved) return false;
        auto node = node_at_parameter(*moved, on_.parameter(), on_.fold > 0 ? 1 : -1);
        if (!node || !((node->at.z - moved->z).norm() < moved_unknowns) || node->check().fault)
            return false;
        on_ = std::move(*node);
        h_ = std::max(h_, first_arc);
        return true;
    }

    /// Where a chatter becomes complete, grazing contacts accumulate, each of which adds an impact.
    /// Goes on beyond, where the ball sticks; false if there is no such orbit.
    bool pass_completion() {
        if (on_.is_return()) return false;
        const auto beyond = beyond_by_return(on_, true);
        if (!beyond) return false;
        // Back to where the sticking phase begins, which is before the present node.
        const double back = std::abs(beyond->parameter() - on_.parameter());
        BranchNode before = std::exchange(on_, *beyond);
        on_.at.tangent *= -1;
        h_ = most_back * back / std::abs(beyond->fold);
        auto birth = on_.after(h_);
        const bool found = birth && clip_to_existence(birth).fault && birth;
        if (!found) {
            on_ = std::move(before);
            return false;
        }
        SpecialPoint stick{SpecialKind::stick, orbit_point(*birth)};
        stick.on = birth->guess();
        sink_.special(number_, stick);
        continue_from(*beyond);
        return true;
    }

    void continue_from(const BranchNode& node) {
        on_ = node;
        sink_.point(number_, orbit_point(on_));
        h_ = first_arc;
    }

    std::optional<BranchEnd> pass_event(const SequenceFault& fault) {
        const bool sticks = fault.kind == SequenceFault::Kind::stick,
                   last = on_.equations->sequence().size() < 2 &&
                          fault.kind == SequenceFault::Kind::missing;
        SpecialPoint event{sticks ? SpecialKind::stick : SpecialKind::grazing, orbit_point(on_)};
        // No equations hold at a grazing contact of a return.
        if (sticks || !on_.is_return()) event.on = on_.guess();
        event.impact = fault.flight;
        if (fault.kind == SequenceFault::Kind::contact)
            if (auto changed = on_.equations->changed(on_.at.z, fault))
                event.on = std::move(*changed);
        const auto beyond = beyond_event(on_, fault);
        if (sticks && !on_.is_return() && beyond) event.on = beyond->guess();
        if (beyond) event.impacts_after = beyond->equations->sequence().impacts();
        sink_.special(number_, event);
        const bool too_many = beyond && beyond->equations->sequence().size() > plan_.most_impacts;
        if ((too_many || (!beyond && !last && !sticks)) && pass_completion()) return std::nullopt;
        if (too_many) return BranchEnd::most_impacts;
        if (!beyond)
            return sticks ? BranchEnd::stick : last ? BranchEnd::last_impact : BranchEnd::grazing;
        continue_from(*beyond);
        if (repeats_itself(on_.guess())) return BranchEnd::parent;
        return std::nullopt;
    }

    /// True if the branch passes its first point again.
    bool is_closed() const {
        const Unknowns& z = on_.at.z;
        if (z.size() != origin_.z.size() || !((z - origin_.z).norm() < 2 * longest_arc))
            return false;
        if (!(origin_.tangent.dot(z - origin_.z) > 0) || points_ < 5) return false;
        const auto there = point_in_plane(
            as_curve(*on_.equations), z, origin_.tangent, origin_.tangent.dot(origin_.z));
        return there && (there->z - origin_.z).norm() < same_unknowns &&
               (z - origin_.z).norm() < h_;
    }

    const BranchPlan& plan_;
    const int number_;
    BranchNode on_;
    const CurvePoint origin_;
    BranchSink& sink_;
    const std::function<void(SpecialKind, const BranchNode&)> branches_off_;
    double h_ = first_arc;
    long points_ = 0;
    int since_moved_ = 0;  // steps since move_section()
};

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
        BranchNode at;
        int depth;
    };
    const double p = start.z(start.z.size() - 1);
    std::deque<Open> queue;
    int numbers = 0;
    for (const int direction : {1, -1})
        if (const auto node = node_at_parameter(start, p, direction))
            queue.push_back({{numbers++, -1, SpecialKind::end, direction}, *node, 0});
    bool is_loop = false;  // then the other direction, number 1, is the same
    for (; !queue.empty(); queue.pop_front()) {
        const Open open = queue.front();
        if (is_loop && open.start.number == 1) continue;
        sink.branch(open.start);
        const auto branches_off = [&](SpecialKind kind, const BranchNode& other) {
            if (open.depth >= plan.switches) return;
            const int direction = other.fold < 0 ? -1 : 1;
            queue.push_back(
                {{numbers++, open.start.number, kind, direction}, other, open.depth + 1});
        };
        BranchFollower follower(plan, open.start.number, open.at, sink, branches_off);
        if (!follower.run()) return false;
        if (open.start.number == 0) is_loop = follower.is_loop;
    }
    return true;
}

}  // namespace vines
