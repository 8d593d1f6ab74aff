#include "core/motion/contacts.hpp"

namespace vines {

namespace {

/// Without those of a chatter but its first.
void fold_chatter(std::vector<CountedContact>& contacts, const StickStart& start) {
    if (start.impacts > 1)
        contacts.resize(contacts.size() - static_cast<std::size_t>(start.impacts - 1));
}

// By this share two impacts of a chatter may be further apart than its flights are long: the
// moments are rounded.
constexpr double hop_margin = 1e-3;

}  // namespace

void ContactRecord::on_impact(const Impact& impact) {
    ++impacts;
    contacts.push_back({impact.tau, impact.side});
}

void ContactRecord::on_stick(const StickStart& start) {
    sticks.push_back({start.tau, start.tau});
    fold_chatter(contacts, start);
}

// A chatter stays on its side, and its flights take less than half a cycle of the faster of forcing
// and oscillator (Run::longest_hop_).
ContactStream::ContactStream(const Parameters& p)
    : longest_hop_((1 + hop_margin) * p.faster_half_cycle()) {}

void ContactStream::on_impact(const Impact& impact) {
    if (!held_.empty() &&
        (impact.side != held_.back().side || impact.tau - held_.back().tau > longest_hop_))
        tell_held();
    held_.push_back({impact.tau, impact.side});
}

void ContactStream::on_stick(const StickStart& start) {
    fold_chatter(held_, start);
    tell_held();
}

void ContactStream::tell_held() {
    for (const CountedContact& contact : held_) on_contact(contact);
    held_.clear();
}

}  // namespace vines
