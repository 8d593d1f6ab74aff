// Admission control: limits how many computations run at once.
//
// The server has more worker threads than cores, so a computation needs one of a fixed number of
// slots (--compute-threads). Work in the foreground and in the background competes for them:
// - foreground: one request. It queues up to a limit and is refused beyond it.
// - background: the points of a sweep, the lists of a streamed answer. It waits without limit, has
//   a ninth or more of the time while others wait, and else leaves its slot to the foreground.
// In each class the client whose work has had least time is next; in the background its foreground
// time counts, too. Work keeps its slot for a time slice, then gives it back if another client's
// work waits.
// Waiting for a slot costs a thread switch, which takes longer than a small answer. A foreground
// request that finds no free slot therefore starts in a grace period of 1 ms without one, and
// waits only if it needs longer (Permit).
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>
#include <stop_token>

#include "http/fair_queue.hpp"
#include "program/process.hpp"

namespace vines::http {

struct AdmissionLimits {
    int running = cores();
    int waiting = 64;  ///< foreground requests in the queue, in addition to the running ones
    int sweeps = 4;    ///< sweeps at once; they share the slots that requests leave free
    /// Bytes of the process from which on little work is interrupted, since it holds memory.
    std::size_t memory = 384 << 20;
};

struct AdmissionLoad {
    int running = 0;             ///< slots in use
    std::size_t waiting = 0;     ///< foreground requests waiting for a slot
    std::size_t background = 0;  ///< background work that waits
    int sweeps = 0;
};

/// Must outlive the slots that it hands out.
class AdmissionControl {
public:
    using Clock = std::chrono::steady_clock;

private:
    struct BySize;
    struct Class;
    struct Release {
        Class* its = nullptr;  // null: of a grace period
        std::string client = {};
        Clock::time_point keeps_until = {};  // of background work that foreground work waits for
        Clock::time_point since = Clock::now();
        void operator()(AdmissionControl* admission) { admission->release(*this); }
    };
    void release(Release& slot);

public:
    explicit AdmissionControl(const AdmissionLimits& limits);

    int threads() const { return limits_.running; }

    /// The right to compute, or null. The destructor gives it back. A grace period is the right for
    /// a moment without a slot; it counts towards the queue's limit.
    using Slot = std::unique_ptr<AdmissionControl, Release>;
    static bool is_grace(const Slot& slot) { return slot && !slot.get_deleter().its; }
    /// For foreground work; does not wait: a slot, a grace period or null. While work waits, grace
    /// periods count for their client like its time, and it gets none while it has had more.
    Slot try_acquire(const std::string& client);
    /// For foreground work: waits for a slot. Null if the queue is full and no client has more in
    /// it, or gives_up() returned true; it is polled every 50 ms. Grace periods, which have no
    /// clients, fill the queue only for a client that waits in it.
    Slot acquire(const std::string& client, const std::function<bool()>& gives_up = {});
    /// For foreground work that has begun: gives its slot or grace period back and waits for a
    /// slot; always finds space in the queue. Work that had a slot, or has given it back before
    /// (null), waits before the client's other work. Null as above.
    Slot resume(const std::string& client, const std::function<bool()>& gives_up, Slot begun);
    /// For foreground work that holds a permit by size, for which others can wait: it has half of
    /// the foreground's time, and all that no other foreground work waits for. It counts as its
    /// client's there, too.
    Slot acquire_urgently(const std::string& client, const std::function<bool()>& gives_up);
    /// Counts the time of foreground work; true if it should resume(): other clients' work is due.
    bool others_are_due(Slot& foreground);
    /// True if other clients' work waits and is not due, since the process uses all of its memory:
    /// foreground work should end.
    bool others_are_stuck(const std::string& client) const;
    /// The right to run one sweep, to be shared with its clients. At the limit the newest one of
    /// the client with most is displaced for a client that then has no more: it should end; of
    /// several clients' that of the one among them with fewest counts. Null if there is none, or
    /// sweeps are stopped.
    struct Sweep {
        std::list<std::string> clients = {};
        std::atomic<bool> is_displaced = false;
    };
    using SweepSlot = std::shared_ptr<Sweep>;
    SweepSlot acquire_sweep(const std::string& client);
    /// The sweep is also this client's until the returned object's end.
    std::shared_ptr<void> share(const SweepSlot& slot, const std::string& client);

    /// For background work: waits for a slot. Null once `stop` is requested or sweeps are stopped.
    /// That of a sweep is that one's of its clients whose turn comes first.
    Slot acquire_background(
        const std::string& client, const std::stop_token& stop = {},
        const SweepSlot& sweep = nullptr);
    /// True if background work should release its slot and wait again: foreground work waits, or
    /// other background work after a time slice.
    bool must_yield(const Slot& background) const;

    /// The right to read a large body and to compute with it. At most one of the largest, and
    /// several that are small together, have it at once, since these take many times their size;
    /// others wait. Null if too many wait and no client has more of them, or gives_up(), polled
    /// every 50 ms, returned true. Smaller bodies have it at once.
    using SizePermit = std::shared_ptr<BySize>;
    /// Records, which keep it until they are identified, do not hold up other bodies.
    SizePermit acquire_body(
        const std::string& client, std::size_t bytes, bool is_record,
        const std::function<bool()>& gives_up);
    /// The right to hold lists of more than immediate_lists bytes while they are computed and their
    /// text is made; as many as fit together. Null if gives_up() returned true. Not to be waited
    /// for with a slot.
    SizePermit acquire_lists(
        const std::string& client, std::size_t bytes, const std::function<bool()>& gives_up);
    /// True if other clients wait for permits like this one (may be null), and its work, which has
    /// it for `age`, is to end for them: after in_need or a part of the round; with no more than an
    /// equal share after twice the time; up to four times later until it has `computed` for the
    /// group's least time.
    bool others_need(
        const SizePermit& permit, const std::string& client, Clock::duration age,
        Clock::duration computed) const;

    /// Running sweeps end at their next check and no new one starts. Requests still compute.
    void stop_sweeps();
    bool sweeps_stopped() const { return sweeps_stopped_; }

    /// All work ends at its next check, with the results it has.
    void stop_all() { all_stopped_ = true; }
    bool all_stopped() const { return all_stopped_; }

    AdmissionLoad load() const;

private:
    struct Waiter {
        std::condition_variable_any changed = {};
        bool granted = false;    ///< a slot, or a permit by size
        bool displaced = false;  ///< by a client that has less in the queue
        bool is_interrupted = false;
        std::size_t bytes = 0;  ///< of a body or of lists
        Clock::time_point since = Clock::now();
        void set(bool Waiter::* state) {
            this->*state = true;
            changed.notify_one();
        }
    };
    using Queue = FairQueue<Waiter*>;  // of slots: a turn for each microsecond
    struct Class {
        int weight = 1;  ///< of the time that it uses
        Queue waiting = {};
        /// Weighted, while other work waited; of what has a slot as if it used a time slice.
        Clock::duration used = {};
    };
    using Lock = std::unique_lock<std::mutex>;

    bool uses(std::size_t bytes) const;
    bool may_interrupt() const;
    int new_waiting() const;
    bool is_full() const;
    void count(Release& slot);
    void give_back(Release& slot);
    int sweeps_of(const std::string& client) const;
    void assign();
    bool end_wait(Queue& queue, Waiter& waiter);
    bool wait(Lock& lock, Queue& queue, Waiter& waiter, const std::function<bool()>& gives_up);
    /// Work that is admitted by its size: several that have at most `at_once` bytes together, or
    /// one.
    struct BySize {
        std::size_t at_once = 0;
        bool is_exempt = false;  ///< also at once where the process uses all of its memory
        Clock::duration in_need = std::chrono::seconds(5);  ///< see others_need()
        Clock::duration round = std::chrono::hours(1);      ///< time for all that wait, likewise
        Clock::duration least = std::chrono::milliseconds(2500);  ///< of computing, likewise
        Queue waiting = {};
        std::map<std::string, std::size_t> clients = {};  ///< bytes of each in work
        std::size_t in_work = 0;                          ///< bytes of all
    };
    BySize* next_by_size();
    SizePermit acquire_by_size(
        Lock& lock, BySize& group, const std::string& client, std::size_t bytes,
        const std::function<bool()>& gives_up);
    static bool make_space(Queue& queue, const std::string& client, std::size_t bytes);

    const AdmissionLimits limits_;
    mutable std::mutex mutex_;
    int free_, graces_ = 0;  // nobody waits while free_ > 0
    int interrupted_ = 0;    // work that waits after a time slice
    mutable Clock::time_point memory_checked_ = {};
    mutable std::size_t resident_ = 0;                        // then, bytes
    Clock::time_point contended_ = Clock::time_point::max();  // since when work waits
    std::list<Sweep> sweeps_;                                 // the newest first
    Class urgent_, foreground_, background_;
    BySize large_bodies_, lesser_bodies_, large_records_, lesser_records_, lists_, immediate_;
    // Written under the mutex; running work reads them without it.
    std::atomic<bool> foreground_waits_ = false, background_waits_ = false;
    std::atomic<bool> sweeps_stopped_ = false, all_stopped_ = false;
};

// Bodies up to this size need no permit, bytes.
inline constexpr std::size_t immediate_body = 1 << 20;

// Lists up to this size need no permit, bytes of their text.
inline constexpr std::size_t immediate_lists = 16 << 20;

// Time for which work keeps a slot that other work of its class waits for.
inline constexpr auto time_slice = std::chrono::milliseconds(5);

/// A foreground request's permission to compute: a slot or a grace period at once, otherwise after
/// a wait. For one thread at a time; the admission control outlives it.
class Permit {
public:
    using Clock = AdmissionControl::Clock;

    /// Waits for a slot if may_begin is false, or if neither a slot nor a grace period is free.
    /// gives_up() is polled while waiting.
    /// is_urgent: it holds a permit by size, for which others can wait; see end_urgency().
    Permit(
        AdmissionControl& admission, std::string client, std::function<bool()> gives_up,
        bool may_begin, bool is_urgent = false);
    /// False if the queue was full or the wait was given up.
    explicit operator bool() const { return slot_ != nullptr; }

    /// To be called regularly: waits for a slot after the grace period, and after a time slice if
    /// other clients' work is due. False if it gave up.
    bool renew();

    /// Gives the slot back while wait() waits for a permit by size. False if that or the wait for a
    /// slot gave up.
    bool wait_without_slot(const std::function<bool()>& wait);

    /// Time spent waiting, without the initial wait.
    Clock::duration waited() const { return waited_; }

    /// From now on it waits with all others.
    void end_urgency() { is_urgent_ = false; }

private:
    AdmissionControl& admission_;
    const std::string client_;
    const std::function<bool()> gives_up_;
    AdmissionControl::Slot slot_;
    bool is_urgent_;
    Clock::duration waited_{};
};

}  // namespace vines::http
