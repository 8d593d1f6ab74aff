#include "core/motion/in_lanes.hpp"

namespace vines {

std::vector<NamedSearch> flight_searches() {
    std::vector<NamedSearch> searches = {baseline_search()};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2")) searches.push_back(avx2_search());
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        searches.push_back(avx512_search());
#endif
    return searches;
}

FlightSearch best_search() {
    static const FlightSearch search = [] {
        const auto searches = flight_searches();
        return searches.size() > 1 ? searches.back().search : nullptr;
    }();
    return search;
}

void put(FlightLanes& flights, const FlightStart& f, double b, double limit) {
    const int lane = flights.count++;
    flights.x[lane] = f.lo.x;
    flights.x_dot[lane] = f.lo.x_dot;
    flights.sin_theta[lane] = f.lo.sin_theta;
    flights.cos_theta[lane] = f.lo.cos_theta;
    flights.y[lane] = f.y;
    flights.y_dot[lane] = f.y_dot;
    flights.side[lane] = f.side;
    flights.relative_speed[lane] = f.relative_speed;
    flights.b[lane] = b;
    flights.limit[lane] = limit;
}

void search(FlightLanes& flights, FlightSearch by) {
    for (int lane = flights.count; lane < FlightLanes::lanes; ++lane) {
        for (auto* column :
             {&flights.x, &flights.x_dot, &flights.sin_theta, &flights.cos_theta, &flights.y,
              &flights.y_dot, &flights.side, &flights.relative_speed, &flights.b, &flights.limit})
            (*column)[lane] = (*column)[0];
    }
    by(flights);
}

Contact contact_of(const FlightLanes& f, int lane) {
    return {
        f.s[lane],
        static_cast<int>(f.wall[lane]),
        {f.contact_x[lane], f.contact_x_dot[lane], f.contact_sin[lane], f.contact_cos[lane]},
        f.contact_speed[lane]};
}

Transfer transfer_of(const FlightLanes& f, int lane) {
    return {f.a11[lane], f.a12[lane], f.a21[lane], f.a22[lane]};
}

}  // namespace vines
