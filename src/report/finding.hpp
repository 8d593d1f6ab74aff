// One number of the paper, or one statement, beside what it turned out to be.
#pragma once

#include <optional>
#include <string>

namespace vines::report {

/// Where a number must lie, ends included.
struct Band {
    double low, high;
    bool contains(double number) const { return number >= low && number <= high; }
};
inline Band exactly(double number) { return {number, number}; }

enum class Verdict {
    reproduced,
    by_closed_form,         ///< reproduced, but not by the damping of eq. (1)
    by_equation_of_motion,  ///< reproduced by that alone
    partly,
    partly_by_closed_form,
    partly_by_equation_of_motion,
    not_reproduced
};

/// A statement of the paper comes down to one number, and to the band where that lies if the
/// statement holds: the verdict follows from the two. The texts are Markdown of one line, without
/// a vertical bar.
struct Finding {
    std::string where;  ///< in the paper: "Fig. 5"
    std::string what;   ///< the quantity, or the statement
    std::string paper;  ///< what the paper says
    std::string here;   ///< what was computed
    double number;      ///< what the verdict rests on
    /// The same by the damping of eq. (1), where the two differ.
    std::optional<double> by_equation = {};
    Band band;            ///< where the number lies if the statement holds
    std::string because;  ///< why there
    /// Wider: where the statement holds in part.
    std::optional<Band> partly = {};
    /// Its number comes from a record computed in place of one of the paper's, which are not
    /// published: the verdict says what such a record shows.
    bool computed_record = false;
    /// What the number was found to say. Another verdict today is an error: `vines reproduce`
    /// fails.
    Verdict expected = Verdict::reproduced;

    Verdict verdict() const {
        const bool here = band.contains(number), other = by_equation && band.contains(*by_equation);
        if (here) return other || !by_equation ? Verdict::reproduced : Verdict::by_closed_form;
        if (other) return Verdict::by_equation_of_motion;
        if (!partly) return Verdict::not_reproduced;
        const bool partly_other = by_equation && partly->contains(*by_equation);
        if (partly->contains(number))
            return partly_other || !by_equation ? Verdict::partly : Verdict::partly_by_closed_form;
        return partly_other ? Verdict::partly_by_equation_of_motion : Verdict::not_reproduced;
    }
    bool stands() const { return verdict() == expected; }
};

inline const char* text_of(Verdict verdict, bool computed_record = false) {
    if (computed_record) switch (verdict) {
            case Verdict::reproduced: return "holds for the computed record";
            case Verdict::partly: return "holds in part for the computed record";
            default: return "**does not hold for the computed record**";
        }
    switch (verdict) {
        case Verdict::reproduced: return "reproduced";
        case Verdict::by_closed_form: return "reproduced, with the closed-form damping alone";
        case Verdict::by_equation_of_motion: return "reproduced, with the damping of eq. (1) alone";
        case Verdict::partly: return "in part";
        case Verdict::partly_by_closed_form: return "in part, with the closed-form damping alone";
        case Verdict::partly_by_equation_of_motion:
            return "in part, with the damping of eq. (1) alone";
        case Verdict::not_reproduced: return "**not reproduced**";
    }
    return "";
}

}  // namespace vines::report
