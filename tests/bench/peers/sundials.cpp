// SUNDIALS: CVODE's Adams methods with its own root finding, restarted after each contact. ARKODE's
// explicit Runge-Kutta methods were tried and are no faster at this accuracy.
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "bench/peers/flight.hpp"

namespace {

using namespace peers;

int derivative(sunrealtype tau, N_Vector motion, N_Vector out, void* flight) {
    const double* m = N_VGetArrayPointer(motion);
    double* d = N_VGetArrayPointer(out);
    d[0] = m[1];
    d[1] = static_cast<const Flight*>(flight)->acceleration(tau, m[0], m[1]);
    return 0;
}

/// Both rise through zero at a contact.
int walls(sunrealtype tau, N_Vector motion, sunrealtype* out, void* flight) {
    const Flight& f = *static_cast<const Flight*>(flight);
    const double relative = f.relative(tau, N_VGetArrayPointer(motion)[0]);
    out[0] = relative - f.b();
    out[1] = -relative - f.b();
    return 0;
}
int outwards[] = {1, 1};

/// Ends a run with the library's error message.
int checked(int flag) {
    if (flag >= 0) return flag;
    const std::unique_ptr<char, decltype(&std::free)> name(CVodeGetReturnFlagName(flag), std::free);
    throw std::runtime_error(name.get());
}

/// Beyond a wall by this fraction of b, a contact has been missed.
constexpr double sunk = 1e-6;

class Context {
public:
    Context() {
#if SUNDIALS_VERSION_MAJOR >= 7
        SUNContext_Create(SUN_COMM_NULL, &context_);
#else
        SUNContext_Create(nullptr, &context_);
#endif
    }
    ~Context() { SUNContext_Free(&context_); }
    operator SUNContext() const { return context_; }

private:
    SUNContext context_;
};
using Vector = std::unique_ptr<std::remove_pointer_t<N_Vector>, decltype(&N_VDestroy)>;

class Cvode {
public:
    Cvode(const Job& job, Flight& flight, N_Vector motion, SUNContext context)
        : memory_(CVodeCreate(CV_ADAMS, context)),
          solver_(SUNNonlinSol_FixedPoint(motion, 0, context)) {
        CVodeInit(memory_, derivative, job.tau, motion);
        CVodeSStolerances(memory_, job.tolerance, job.tolerance * job.b);
        CVodeSetUserData(memory_, &flight);
        CVodeSetNonlinearSolver(memory_, solver_);
        CVodeRootInit(memory_, 2, walls);
        CVodeSetRootDirection(memory_, outwards);
        CVodeSetNoInactiveRootWarn(memory_);
        CVodeSetMaxStep(memory_, job.longest_step);
        CVodeSetStopTime(memory_, job.tau_end);
    }
    ~Cvode() {
        CVodeFree(&memory_);
        SUNNonlinSolFree(solver_);
    }
    void start(double tau, N_Vector motion, double first_step) {
        checked(CVodeReInit(memory_, tau, motion));
        CVodeSetInitStep(memory_, first_step);
    }
    int step(double tau_end, N_Vector motion, double& tau) {
        return checked(CVode(memory_, tau_end, motion, &tau, CV_ONE_STEP));
    }

private:
    void* memory_;
    SUNNonlinearSolver solver_;
};

void follow(const Job& job, Answer& answer) {
    const Context context;
    const Vector motion(N_VNew_Serial(2, context), N_VDestroy);
    double* const m = N_VGetArrayPointer(motion.get());
    m[0] = job.x, m[1] = job.x_dot;
    Flight flight(job);
    Cvode integrator(job, flight, motion.get(), context);
    // 0: the library's default first step.
    const auto first_step = [&] {
        const double step = flight.first_step(m[1], 1);
        return step < 1 ? step : 0;
    };
    integrator.start(job.tau, motion.get(), first_step());
    for (double tau = job.tau; tau < job.tau_end;) {
        const int flag = integrator.step(job.tau_end, motion.get(), tau);
        if (flag == CV_ROOT_RETURN) {
            m[1] = flight.strike(tau, m[0], m[1]);
            answer.contacts.push_back({tau, flight.side()});
            if (stalled(answer.contacts)) throw std::runtime_error("stalled");
            integrator.start(tau, motion.get(), first_step());
        } else if (flight.beyond(tau, m[0]) > sunk * job.b) {
            throw std::runtime_error("through the wall");
        }
    }
}

}  // namespace

int main() {
    std::freopen("/dev/null", "w", stderr);  // discards the library's messages; it also returns the
                                             // errors
    return serve("SUNDIALS " SUNDIALS_VERSION, {{"cvode", guarded<follow>}});
}
