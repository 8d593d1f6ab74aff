#include "api/schema/words.hpp"

namespace vines::api {

namespace {

constexpr Word<Damping> dampings[] = {
    {Damping::equation_of_motion, "equation_of_motion"}, {Damping::closed_form, "closed_form"}};

constexpr Word<Status> statuses[] = {
    {Status::ok, "ok"},
    {Status::minus_infinity, "minus_infinity"},
    {Status::not_converged, "not_converged"}};

constexpr Word<Verdict> verdicts[] = {
    {Verdict::chaotic, "chaotic"},
    {Verdict::regular, "regular"},
    {Verdict::not_decided, "not_decided"},
    {Verdict::none, nullptr}};

constexpr Word<SectionKind> sections[] = {
    {SectionKind::none, "none"},
    {SectionKind::impact, "impact"},
    {SectionKind::stroboscopic, "stroboscopic"}};

constexpr Word<Carry> carries[] = {{Carry::none, "none"}, {Carry::up, "up"}, {Carry::down, "down"}};

}  // namespace

template <>
std::span<const Word<Damping>> words() {
    return dampings;
}
template <>
std::span<const Word<Status>> words() {
    return statuses;
}
template <>
std::span<const Word<Verdict>> words() {
    return verdicts;
}
template <>
std::span<const Word<SectionKind>> words() {
    return sections;
}
template <>
std::span<const Word<Carry>> words() {
    return carries;
}

}  // namespace vines::api
