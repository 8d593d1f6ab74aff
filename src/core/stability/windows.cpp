#include "core/stability/windows.hpp"

#include <algorithm>

namespace vines {

void Windows::add(double tau_start, double tau_end) {
    windows_.push_back({tau_start, tau_end, Lyapunov(parameters_, tau_start, tau_end, options_)});
}

void Windows::on_stretch(const Stretch& stretch) {
    for (Window* w : open_) w->lyapunov.on_stretch(stretch);
}

void Windows::on_impact(const Impact& impact) {
    if (!begun_) {
        for (Window& w : windows_) waiting_.push_back(&w);
        std::sort(waiting_.begin(), waiting_.end(), [](const Window* a, const Window* b) {
            return a->tau_start > b->tau_start;
        });
        begun_ = true;
    }
    for (; !waiting_.empty() && waiting_.back()->tau_start <= impact.tau; waiting_.pop_back())
        open_.push_back(waiting_.back());
    std::erase_if(open_, [&](const Window* w) { return w->tau_end < impact.tau; });
    for (Window* w : open_) w->lyapunov.on_impact(impact);
}

}  // namespace vines
