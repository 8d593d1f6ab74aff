// The quantities of answers: key, meaning, type and SI counterpart of each. JSON, SI counterparts,
// CSV, CBOR and npz, lists of impacts in requests, the OpenAPI document, the tables of docs/api.md
// and the bound of an answer's size follow from them.
//
// A part of an answer (columns.cpp) refers to a quantity as `quantity.tau`; with() and or_null()
// adapt meaning and type to the part. Quantities of one part only stand in that part's table.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "api/schema/field.hpp"
#include "core/motion/parameters.hpp"

namespace vines::api {

/// The type of a value, or of the entries of a list.
enum class ValueType : std::uint8_t {
    number,
    number_or_null,  ///< null: the number does not exist
    whole,           ///< an integer >= 0
    wall,            ///< 1 for the wall at +b, -1 for the wall at -b
    flag,
    word,
    word_or_null,
    component,  ///< a component of the state
    moduli,     ///< four numbers
    exponents,  ///< four numbers or nulls
    statuses,   ///< of four exponents
    matrix,     ///< 4 x 4 numbers, by rows
    interval,   ///< [from, to]
    interval_or_null,
    damping,
    regime,
    verdict
};

struct Quantity {
    const char* name;
    const char* meaning;
    ValueType type = ValueType::number;
    const char* si_name = nullptr;  ///< key of the SI counterpart, value * omega0^power
    int power = 0;
    bool per_m1 = false;   ///< the SI counterpart is also multiplied by m1
    bool is_rate = false;  ///< the SI counterpart is per second

    /// The same quantity with another meaning.
    constexpr Quantity with(const char* own_meaning) const {
        Quantity q = *this;
        q.meaning = own_meaning;
        return q;
    }
    /// The same number, which is null where it does not exist.
    constexpr Quantity or_null() const {
        Quantity q = *this;
        q.type = ValueType::number_or_null;
        return q;
    }
};

/// The quantities that occur in several parts, and all those with SI counterparts: s for a time,
/// m/s for a velocity, m/s^2 for an acceleration, N s for an impulse. SI counterparts stand in
/// answers in this order.
struct Quantities {
    using enum ValueType;
    Quantity tau{"tau", "time", number, "time_s", -1};
    Quantity tau_error{
        "tau_error", "standard error of the time", number_or_null, "time_error_s", -1};
    Quantity tau_start{"tau_start", "start", number, "time_start_s", -1};
    Quantity tau_end{"tau_end", "end", number, "time_end_s", -1};
    Quantity tau_half{
        "tau_half", "time at which half of the energy is left; null if not reached", number_or_null,
        "time_half_s", -1};
    Quantity tau_tenth{
        "tau_tenth", "time at which a tenth is left; null if not reached", number_or_null,
        "time_tenth_s", -1};
    Quantity time_difference{
        "time_difference", "time since the previous impact; null for the first impact of the run",
        number_or_null, "time_difference_s", -1};
    Quantity window{"window", "interval", number, "window_s", -1};
    Quantity asked{"asked", "requested window", number, "asked_s", -1};
    Quantity parted{
        "parted",
        "time from which the impacts of both runs no longer correspond; null if they always do",
        number_or_null, "parted_s", -1};
    Quantity x_dot{"x_dot", "velocity of the oscillator", number, "x_velocity", 1};
    Quantity y_dot{"y_dot", "velocity of the ball", number, "y_velocity", 1};
    Quantity x_ddot{
        "x_ddot", "acceleration of the oscillator between impacts", number, "x_acceleration", 2};
    Quantity x_relative{"x_relative", "displacement of the oscillator relative to the base, m"};
    Quantity x_dot_before{
        "x_dot_before", "velocity of the oscillator", number, "x_velocity_before", 1};
    Quantity x_dot_after{
        "x_dot_after", "velocity of the oscillator", number, "x_velocity_after", 1};
    Quantity y_dot_before{"y_dot_before", "velocity of the ball", number, "y_velocity_before", 1};
    Quantity y_dot_after{"y_dot_after", "velocity of the ball", number, "y_velocity_after", 1};
    Quantity x_ddot_before{
        "x_ddot_before", "acceleration of the oscillator", number, "x_acceleration_before", 2};
    Quantity relative_speed{
        "relative_speed", "|x' - y'| before the impact", number, "impact_speed", 1};
    Quantity impulse{"impulse", "impulse on the ball per m1, epsilon (y'+ - y'-)",
                     number,    "impulse_N_s",
                     1,         true};
    Quantity x_ddot_max{
        "x_ddot_max", "largest |x''| of the oscillator between impacts", number,
        "x_acceleration_max", 2};
    Quantity relative_speed_max{
        "relative_speed_max", "largest |x' - y'| before an impact", number, "impact_speed_max", 1};
    Quantity impulse_per_m1_max{
        "impulse_per_m1_max",
        "largest impulse of an impact per m1, epsilon |y'+ - y'-|",
        number,
        "impulse_max",
        1,
        true};
    Quantity impact_rate{
        "impact_rate", "impacts per unit of tau", number, "impacts_per_second", 1, false, true};
    Quantity V{"V", "speed of the ball, m per unit of tau", number, "V_velocity", 1};
    Quantity C{"C", "amplitude of the oscillator, m"};
    Quantity x{"x", "displacement of the oscillator, m"};
    Quantity y{"y", "displacement of the ball, m"};
    Quantity side{"side", "sign of x - y", wall};
    Quantity distance{
        "distance", "Euclidean length of the difference in (x', x, y', y), through impacts"};
    Quantity predicted_distance{
        "distance", "length of the tangent vector; null where it overflows", number_or_null};
    Quantity rounding_floor{
        "rounding_floor", "exponents below this value are rounding only", number_or_null};
    Quantity phase{"phase", "phase of the forcing, Omega tau + phi, in [0, 2 pi)"};
};
inline constexpr Quantities quantity;

/// The members of a table of quantities.
template <class Table>
auto members_of(const Table& table) {
    return std::bit_cast<std::array<Quantity, sizeof(Table) / sizeof(Quantity)>>(table);
}

/// The energies of the part `energy`, per m1 omega0^2; SI: J.
struct Energies {
    using enum ValueType;
    Quantity input{"input", "work of the forcing", number, "input_J", 2, true};
    Quantity damper{"damper", "energy dissipated by the damper, 2 zeta x'", number, "damper_J", 2,
                    true};
    Quantity impacts{"impacts", "energy dissipated in impacts", number, "impacts_J", 2, true};
    Quantity friction{
        "friction", "energy dissipated by friction of the ball", number, "friction_J", 2, true};
    Quantity stored{
        "stored", "stored energy at the end minus that at the start", number, "stored_J", 2, true};
    Quantity residual{"residual", "error of the balance", number, "residual_J", 2, true};
    Quantity at_start{"at_start", "stored energy at the start", number, "at_start_J", 2, true};
    Quantity at_end{"at_end", "stored energy at the end", number, "at_end_J", 2, true};
};
inline constexpr Energies energies;

/// The SI counterpart of a quantity over its value.
double si_factor(const Quantity& quantity, const SiParameters& si);

/// Adds the SI counterparts to an object and to everything in it: time_s for tau, x_velocity (m/s)
/// for x_dot, impulse_N_s for impulse. Nulls stay null; a counterpart that the object has stays.
void add_si(Json& part, const SiParameters& si);

/// Adds those of the part `energy`: input_J for input.
void add_joules(Json& energy, const SiParameters& si);

}  // namespace vines::api
