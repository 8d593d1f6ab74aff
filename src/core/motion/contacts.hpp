// Where the two masses meet: what the regimes and the orbits count.
#pragma once

#include <vector>

#include "core/motion/simulate.hpp"

namespace vines {

/// An impact, or a whole chatter that ended in a stick: one meeting of the two masses.
struct CountedContact {
    double tau;
    int side;
};

class ContactRecord : public Observer {
public:
    struct Stick {
        double tau_start, tau_end;
    };

    void on_impact(const Impact& impact) override;
    void on_stick(const StickStart& start) override;
    void on_release(double tau) override { sticks.back().tau_end = tau; }

    std::vector<CountedContact> contacts;
    std::vector<Stick> sticks;
    long impacts = 0;
};

/// Tells the same contacts one by one and keeps none of them, but for the impacts that may be a
/// chatter still: only its stick makes one contact of them.
class ContactStream : public Observer {
public:
    explicit ContactStream(const Parameters& parameters);

    void on_impact(const Impact& impact) override;
    void on_stick(const StickStart& start) override;

protected:
    virtual void on_contact(const CountedContact& contact) = 0;
    /// Tells what is held back; after the run.
    void tell_held();

private:
    const double longest_hop_;
    std::vector<CountedContact> held_;
};

}  // namespace vines
