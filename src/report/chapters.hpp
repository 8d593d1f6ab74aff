// Chapters of the report. Each runs the system, compares the paper's statements with the result,
// and adds its findings and pictures to the report. `report.cpp` sets their order.
#pragma once

#include "report/report.hpp"
#include "report/runs.hpp"

namespace vines::report {

using Chapter = void(Report&, RunCache&);

Chapter model;                ///< Table 1, the closed form against eq. (1), Fig. 2
Chapter strongly_modulated;   ///< Figs. 3 and 4: the motion at b = 22 mm
Chapter transient_exponents;  ///< Fig. 5: its Lyapunov exponents
Chapter transfer_matrices;    ///< Figs. 6 to 9: the eigenvalues of its J, M and T
Chapter table_2;              ///< Table 2: its exponents over other windows
Chapter other_regimes;        ///< Figs. 10 to 14: Types I and III to VI
Chapter table_3;              ///< Table 3: the exponents at ten values of b
Chapter experiment;           ///< Table 4, Figs. 15 to 24: exponents from measurements
Chapter open_questions;       ///< the borders of the regimes; misprints

}  // namespace vines::report
