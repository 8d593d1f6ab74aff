// The field `forcing`: a record or a formula in SI, as a load of the core.
#include <algorithm>

#include "api/system.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

constexpr std::size_t most_samples = 200000;
constexpr double most_periods = 5000;  // of a half sine or a chirp
constexpr std::size_t most_harmonics = 64;

/// The moved quantities, in the order of LoadKind: a record's column or a formula's amplitude.
const std::vector<std::string> quantities = {"acceleration_m_s2", "displacement_m", "force_N"};

/// The fields of a formula besides its amplitude.
struct Formula {
    const char* kind;
    bool of_quantity;  ///< its amplitude is one of `quantities`
    std::vector<std::string> required, optional;
};
const std::vector<Formula> formulas = {
    {"half_sine", true, {"duration_s"}, {}},
    {"chirp", true, {"f_from", "f_to", "duration_s"}, {"rate", "phase"}},
    {"noise", false, {"rms_m_s2", "f_low", "f_high", "duration_s"}, {"seed"}},
    {"harmonics", false, {"f", "F"}, {"phase"}},
};

struct Reader {
    const Json& given;
    const SiParameters& si;
    const double omega0 = si.omega0();
    std::vector<FieldError> errors = {};

    void fail(
        const std::string& where, const Json& value, const Json& range, const std::string& detail) {
        errors.push_back({"/forcing" + where, value, range, "forcing " + detail});
    }
    /// A number, which a query gives as a list of one.
    double number(const std::string& name, double fallback = 0) const {
        if (!given.contains(name)) return fallback;
        const Json& value = given[name];
        return (value.is_array() ? value[0] : value).get<double>();
    }
    double Omega(const std::string& name) const { return number(name) / si.f0(); }

    /// The one quantity that moves.
    struct Moved {
        std::string name;
        LoadKind kind;
        double unit;  ///< in SI
    };
    Moved moved() {
        const auto there = present(given, quantities);
        if (there.size() != 1)
            fail(
                "", nullptr, nullptr, "needs one of acceleration_m_s2, displacement_m and force_N");
        refuse_any(errors);
        const auto kind = std::ranges::find(quantities, there[0]) - quantities.begin();
        const double units[] = {omega0 * omega0, 1, si.k1};
        return {there[0], static_cast<LoadKind>(kind), units[kind]};
    }

    /// Makes the load, whose fields are checked; in up to a tenth of a second.
    using Maker = std::function<std::shared_ptr<const Load>()>;

    Maker record() {
        for (const auto& [name, value] : given.items())
            if (name != "time_s" && std::ranges::find(quantities, name) == quantities.end())
                fail(
                    "/" + name, beginning_of(value), nullptr,
                    name + " belongs to a formula: give its kind, and no time_s");
        if (!given.contains("time_s")) fail("/time_s", nullptr, nullptr, "needs time_s, or a kind");
        const auto [column, kind, unit] = moved();
        if (!given[column].is_array())
            fail("/" + column, given[column], nullptr, "needs a list in " + column);
        refuse_any(errors);
        const Json &time = given["time_s"], &samples = given[column];
        if (time.size() < 2 || time.size() > most_samples)
            fail(
                "/time_s", time.size(), Json::array({2, most_samples}),
                "needs at least two samples and at most " + std::to_string(most_samples));
        if (samples.size() != time.size())
            fail(
                "/" + column, samples.size(), Json::array({time.size(), time.size()}),
                "needs one value for each time");
        refuse_any(errors);
        if (const std::size_t wrong = first_not_ascending(time); wrong < time.size())
            fail("/time_s/" + std::to_string(wrong), time[wrong], nullptr, "needs ascending times");
        refuse_any(errors);
        return [this, &time, &samples, kind = kind, unit = unit] {
            auto tau = time.get<std::vector<double>>(), values = samples.get<std::vector<double>>();
            for (std::size_t i = tau.size(); i-- > 0;) tau[i] = (tau[i] - tau[0]) * omega0;
            for (double& value : values) value /= unit;
            return std::make_shared<const Load>(kind, tau, values);
        };
    }

    void check_fields(const Formula& formula) {
        const std::string& kind = formula.kind;
        for (const auto& [name, value] : given.items()) {
            const auto among = [&name = name](const auto& list) {
                return std::ranges::find(list, name) != list.end();
            };
            if (name != "kind" && !among(formula.required) && !among(formula.optional) &&
                !(formula.of_quantity && among(quantities)))
                fail(
                    "/" + name, beginning_of(value), nullptr,
                    name + " does not belong to the kind " + kind);
        }
        for (const std::string& name : formula.required)
            if (!given.contains(name))
                fail("/" + name, nullptr, nullptr, "of the kind " + kind + " needs " + name);
        refuse_any(errors);
    }

    /// Refuses a load with too many pieces; `fastest`: Omega.
    void limit_periods(double fastest) {
        const double duration = number("duration_s"),
                     periods = std::max(fastest, 1.0) * duration * si.f0();
        if (periods > most_periods)
            fail(
                "/duration_s", given["duration_s"],
                Json::array({0, duration * most_periods / periods}),
                "of the kind " + given["kind"].get<std::string>() +
                    " is limited to 5000 periods of its highest frequency, and of the oscillator");
        refuse_any(errors);
    }

    Maker half_sine(LoadKind kind, double amplitude) {
        const double duration = number("duration_s") * omega0, Omega = std::numbers::pi / duration;
        limit_periods(0);
        const auto theta = [Omega](double tau) { return Polynomial{Omega * tau, Omega}; };
        return [=] { return std::make_shared<const Load>(kind, amplitude, duration, theta); };
    }

    Maker chirp(LoadKind kind, double amplitude) {
        const double from = Omega("f_from"), to = Omega("f_to"),
                     duration = number("duration_s") * omega0, phase = number("phase");
        limit_periods(std::max(from, to));
        const bool logarithmic = given.value("rate", "linear") == "logarithmic" && from != to;
        const double growth =
            (logarithmic ? elementary::log(to / from) : 0.5 * (to - from)) / duration;
        const auto theta = [=](double tau) {
            if (!logarithmic)
                return Polynomial{
                    phase + tau * (from + growth * tau), from + 2 * growth * tau, growth};
            const double Omega = from * elementary::exp(growth * tau);
            Polynomial theta{phase + (Omega - from) / growth};
            double term = Omega;
            for (int n = 1; n < Polynomial::most; ++n) {
                theta.add(n, term / n);
                term *= growth / n;
            }
            return theta;
        };
        return [=] { return std::make_shared<const Load>(kind, amplitude, duration, theta); };
    }

    Maker noise() {
        const double low = Omega("f_low"), high = Omega("f_high"),
                     duration = number("duration_s") * omega0;
        const auto [first, last] = Load::noise_lines(low, high, duration);
        if (first > last)
            fail(
                "/f_high", given["f_high"], nullptr,
                "of the kind noise needs a multiple of 1/duration_s between f_low and f_high");
        else if (high * duration > Load::most_noise_phase)
            fail(
                "/duration_s", given["duration_s"],
                Json::array({0, number("duration_s") * Load::most_noise_phase / (high * duration)}),
                "of the kind noise is limited to 8192 periods of f_high");
        refuse_any(errors);
        const double rms = number("rms_m_s2") / (omega0 * omega0);
        const auto seed = static_cast<std::uint64_t>(number("seed", 1));
        return [=] {
            return std::make_shared<const Load>(Load::noise(rms, low, high, duration, seed));
        };
    }

    Maker harmonics() {
        const std::size_t count = given["f"].size();
        if (count < 1 || count > most_harmonics)
            fail(
                "/f", count, Json::array({1, most_harmonics}),
                "of the kind harmonics needs 1 to 64 frequencies");
        for (const std::string name : {"F", "phase"})
            if (given.contains(name) && !given[name].is_array())
                fail("/" + name, given[name], nullptr, "needs a list in " + name);
            else if (given.contains(name) && given[name].size() != count)
                fail(
                    "/" + name, given[name].size(), Json::array({count, count}),
                    "of the kind harmonics needs one value in " + name + " for each frequency");
        refuse_any(errors);
        std::vector<LoadHarmonic> list;
        for (std::size_t i = 0; i < count; ++i) {
            const double f = given["f"][i].get<double>(), Omega = f / si.f0();
            if (!(Omega >= 0 && Omega <= 100))
                fail(
                    "/f/" + std::to_string(i), f, Json::array({0, 100 * si.f0()}),
                    "of the kind harmonics needs frequencies from 0 to 100 f0");
            list.push_back(
                {given["F"][i].get<double>(), Omega,
                 given.contains("phase") ? given["phase"][i].get<double>() : 0});
        }
        refuse_any(errors);
        return [list] { return std::make_shared<const Load>(list); };
    }

    Maker checked() {
        if (!given.contains("kind")) return record();
        const Formula& formula = *std::ranges::find_if(
            formulas, [this](const Formula& f) { return given["kind"] == f.kind; });
        check_fields(formula);
        if (!formula.of_quantity) return given["kind"] == "noise" ? noise() : harmonics();
        const auto [name, kind, unit] = moved();
        // A list of one, as a query gives it, is a number.
        for (const std::string& field : present(given, {name, "phase"}))
            if (given[field].is_array() && given[field].size() != 1)
                fail("/" + field, given[field].size(), nullptr, "needs one number in " + field);
        refuse_any(errors);
        const double amplitude = number(name) / unit;
        return given["kind"] == "chirp" ? chirp(kind, amplitude) : half_sine(kind, amplitude);
    }
};

}  // namespace

std::shared_ptr<const Load> ForcingField::load(const SiParameters& si) const {
    const std::lock_guard lock(mutex_);
    if (!last_ || omega0_ != si.omega0() || k1_ != si.k1) {
        Reader field{given_, si};
        last_ = field.checked()();
        omega0_ = si.omega0(), k1_ = si.k1;
    }
    return last_;
}

void ForcingField::check(const SiParameters& si) const { Reader{given_, si}.checked(); }

std::size_t ForcingField::bytes(double f0) const {
    constexpr double of_sample = 40, of_period = 2600, most = 16 << 20;
    const SiParameters any;
    const Reader field{given_, any};
    const double samples = given_.contains("time_s") ? given_["time_s"].size() : 0,
                 f = std::max(
                     {f0, field.number("f_high"), field.number("f_from"), field.number("f_to")}),
                 periods = f * field.number("duration_s");
    return static_cast<std::size_t>(std::min(most, of_sample * samples + of_period * periods));
}

}  // namespace vines::api
