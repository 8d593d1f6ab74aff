#include "core/motion/contacts.hpp"

namespace vines {

void ContactRecord::on_impact(const Impact& impact) {
    ++impacts;
    contacts.push_back({impact.tau, impact.side});
}

void ContactRecord::on_stick(const StickStart& start) {
    sticks.push_back({start.tau, start.tau});
    if (start.impacts > 1)
        contacts.resize(contacts.size() - static_cast<std::size_t>(start.impacts - 1));
}

}  // namespace vines
