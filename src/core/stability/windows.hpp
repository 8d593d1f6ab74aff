// The exponents of many windows of one run, which are fed only while they are open.
#pragma once

#include <vector>

#include "core/stability/lyapunov.hpp"

namespace vines {

class Windows : public Observer {
public:
    Windows(const Parameters& parameters, const ExponentOptions& options)
        : parameters_(parameters),
          options_(options) {}
    /// Before the run. The products come in the order of these calls.
    void add(double tau_start, double tau_end);

    void on_stretch(const Stretch&) override;
    void on_impact(const Impact&) override;

    std::size_t size() const { return windows_.size(); }
    const TransferProduct& product(std::size_t i) const { return windows_[i].lyapunov.product(); }
    /// After the run.
    TransferProduct take(std::size_t i) { return windows_[i].lyapunov.take(); }

private:
    struct Window {
        double tau_start, tau_end;
        Lyapunov lyapunov;
    };
    const Parameters parameters_;
    const ExponentOptions options_;
    std::vector<Window> windows_;
    // From the first impact on: those not begun, the latest start first.
    std::vector<Window*> waiting_;
    std::vector<Window*> open_;
    bool begun_ = false;
};

}  // namespace vines
