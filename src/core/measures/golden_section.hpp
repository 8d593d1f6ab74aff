// Search for a maximum by golden sections.
#pragma once

namespace vines {

/// Place of the maximum of a function with one in [low, high], to `tolerance`.
template <class Function>
double golden_maximum(const Function& function, double low, double high, double tolerance) {
    constexpr double golden = 0.6180339887498949;
    double left = high - golden * (high - low), right = low + golden * (high - low),
           at_left = function(left), at_right = function(right);
    while (high - low > tolerance) {
        if (at_left > at_right) {
            high = right, right = left, at_right = at_left;
            left = high - golden * (high - low), at_left = function(left);
        } else {
            low = left, left = right, at_left = at_right;
            right = low + golden * (high - low), at_right = function(right);
        }
    }
    return 0.5 * (low + high);
}

}  // namespace vines
