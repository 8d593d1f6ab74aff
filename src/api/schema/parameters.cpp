// GET /v1/parameters: the model with its symbols, and the tables of fields as JSON.
#include "api/schema/enum_names.hpp"
#include "api/schema/tables.hpp"

namespace vines::api {

namespace {

Json describe(const FieldTable& table) {
    Json list = Json::array();
    for (const Field& f : table) {
        Json entry = {{"name", f.name},       {"type", enum_name(f.type)},
                      {"group", f.group},     {"unit", f.unit},
                      {"symbol", f.symbol},   {"description", f.description},
                      {"default", f.fallback}};
        if (!f.fallback_note.empty()) entry["default_note"] = f.fallback_note;
        if (f.range) {
            entry["minimum"] = f.range->minimum;
            entry["maximum"] = f.range->maximum;
        }
        if (!f.choices.empty()) entry["choices"] = f.choices;
        if (!f.fields.empty()) entry["fields"] = describe(f.fields);
        list.push_back(std::move(entry));
    }
    return list;
}

/// Equation (1) of the paper, in SI and reduced, and the meaning of each symbol.
Json describe_model() {
    return {
        {"equations",
         {"m1 x'' + c1 x' + k1 x = k1 F sin(2 pi f t) + 2 pi f c1 F cos(2 pi f t), m2 y'' = 0 "
          "while |x - y| < b, derivatives in t (s)",
          "x'' + 2 zeta x' + x = epsilon G sin(Omega tau) + epsilon^2 lambda G Omega cos(Omega "
          "tau), y'' = 0 while |x - y| < b, derivatives in tau = omega0 t",
          "at |x - y| = b: x' + epsilon y' is conserved, x' - y' is reversed and multiplied by R",
          "with gravity and friction: y'' = gravity - friction sgn(y' - x'), and x'' gains epsilon "
          "friction sgn(y' - x')"}},
        {"symbols",
         {{"x",
           "absolute displacement of the linear oscillator (mass m1) from rest, in a frame that "
           "does not move with the base"},
          {"y",
           "absolute displacement of the ball (mass m2); x - y = 0 in the middle of the cavity"},
          {"F",
           "amplitude of the base in m, which moves by F sin(2 pi f t) and carries spring k1 and "
           "damper c1; F = epsilon G"},
          {"b",
           "clearance: half-width of the cavity, whose length is 2 b plus the diameter of the "
           "ball; the walls are at x - y = b (side 1) and x - y = -b (side -1)"},
          {"omega0", "sqrt(k1/m1), rad/s"},
          {"epsilon", "m2/m1"},
          {"lambda", "c1/(m2 omega0)"},
          {"Omega", "2 pi f/omega0"},
          {"G", "F/epsilon, m"},
          {"zeta",
           "epsilon lambda/2 = c1/(2 m1 omega0) with damping equation_of_motion, twice that with "
           "closed_form"}}},
        {"sketch", "system.svg"}};
}

}  // namespace

Json describe_fields() {
    Json all = {{"model", describe_model()}};
    for (const ListedTable& table : listed_tables) all[table.key] = describe(table.fields());
    return all;
}

}  // namespace vines::api
