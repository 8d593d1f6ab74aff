#include "http/admission_control.hpp"

#include "http/memory.hpp"

namespace vines::http {

namespace {

// Interval at which a waiting request checks whether to give up.
constexpr auto give_up_check = std::chrono::milliseconds(50);

// Grace periods at once per slot: they share its core.
constexpr int graces_per_slot = 4;

// Work that waits after a time slice, per slot, whatever its memory.
constexpr int interrupted_per_slot = 8;

// Time for which a look at the memory holds: little is allocated in it, and a look takes 15 us.
constexpr auto memory_look = std::chrono::milliseconds(5);

// The time of background work counts this many times, so that it has a ninth of it or more.
constexpr int background_weight = 4;

// Bodies above immediate_body are read together up to this size; of larger ones one at a time,
// beside them. While they are read and computed they take up to fifteen times their size, one of
// the largest up to 340 MB. Bytes.
constexpr std::size_t bodies_at_once = 4 << 20;
// The same of records, which take up to five times their size, but long.
constexpr std::size_t lesser_records_at_once = 16 << 20, records_at_once = 64 << 20;

// Lists at once, which an interrupted run keeps; they take as much memory as their text. Bytes.
constexpr std::size_t lists_at_once = 256 << 20;

// Larger bodies that wait, and bytes of those beside each client's first; each occupies a worker.
constexpr std::size_t most_waiting_bodies = 32, most_waiting_bytes = 256 << 20;

// Many times the duration of a small answer, and short compared to a time slice of the scheduler.
constexpr std::chrono::microseconds grace_time(1000);

}  // namespace

AdmissionControl::AdmissionControl(const AdmissionLimits& limits)
    : limits_(limits),
      free_(limits.running),
      background_{background_weight},
      large_bodies_{bodies_at_once},
      lesser_bodies_{bodies_at_once},
      large_records_{records_at_once, true},
      lesser_records_{lesser_records_at_once, true},
      lists_{
          lists_at_once, true, std::chrono::seconds(2), std::chrono::seconds(8),
          std::chrono::milliseconds(200)} {}

/// Grants what is free to the next in the queues, and wakes only these threads.
void AdmissionControl::assign() {
    const auto grant_next = [](Queue& queue) {
        Waiter& next = **queue.pop();
        next.set(&Waiter::granted);
        return next.bytes;
    };
    const std::array classes{&urgent_, &foreground_, &background_};
    for (; free_ > 0; --free_) {
        Class* next = nullptr;  // that has had least time
        for (Class* const its : classes)
            if (!its->waiting.empty() && (!next || its->used < next->used)) next = its;
        if (!next) break;
        for (Class* const its : classes)
            if (its->waiting.empty()) its->used = std::max(its->used, next->used);
        next->used += next->weight * time_slice;
        grant_next(next->waiting);
    }
    foreground_waits_ = !foreground_.waiting.empty() || !urgent_.waiting.empty();
    background_waits_ = !background_.waiting.empty();
    const bool waits = foreground_waits_ || background_waits_;
    contended_ = waits ? std::min(contended_, Clock::now()) : Clock::time_point::max();
    while (BySize* const group = next_by_size()) group->in_work += grant_next(group->waiting);
}

/// Counts the time since the last count in which other work waited for what has the slot.
void AdmissionControl::count(Release& slot) {
    const Clock::time_point now = Clock::now(), from = std::max(slot.since, contended_);
    slot.since = now;
    if (now <= from) return;
    const auto used = std::chrono::duration_cast<std::chrono::microseconds>(now - from);
    slot.its->used += slot.its->weight * used;
    for (Class* const its : {&background_, &urgent_, &foreground_}) {
        its->waiting.charge(slot.client, used.count());
        if (slot.its == &background_) break;
    }
}

void AdmissionControl::give_back(Release& slot) {
    if (!slot.its) return void(--graces_);
    ++free_;
    count(slot);
    slot.its->used -= slot.its->weight * time_slice;
}

/// The group whose work has waited longest, among those whose next work may begin; null if there is
/// none. While the process uses all of its memory, one body may, and exempt work beside it.
AdmissionControl::BySize* AdmissionControl::next_by_size() {
    const std::array groups{
        &large_bodies_, &lesser_bodies_, &large_records_, &lesser_records_, &lists_};
    const auto may_begin = [&](const BySize* group) {
        if (group->waiting.empty() ||
            (group->in_work > 0 && group->in_work + group->waiting.front()->bytes > group->at_once))
            return false;
        return group->is_exempt || !uses(limits_.memory) ||
               std::ranges::none_of(groups, [](const BySize* other) {
                   return other->in_work > 0 && !other->is_exempt;
               });
    };
    BySize* next = nullptr;
    auto oldest = Clock::time_point::max();
    for (BySize* const group : groups)
        if (may_begin(group))
            group->waiting.for_each([&](const Waiter* waiter) {
                if (waiter->since < oldest) next = group, oldest = waiter->since;
            });
    return next;
}

/// Ends a wait; returns whether it was granted.
bool AdmissionControl::end_wait(Queue& queue, Waiter& waiter) {
    if (waiter.granted) return true;
    queue.remove(&waiter);
    assign();
    return false;
}

/// Waits in a queue until the waiter, which is in it, is granted what it waits for, is displaced,
/// or gives up. Returns whether it was granted.
bool AdmissionControl::wait(
    Lock& lock, Queue& queue, Waiter& waiter, const std::function<bool()>& gives_up) {
    assign();
    bool given_up = false;
    while (!waiter.granted && !waiter.displaced && !given_up) {
        waiter.changed.wait_for(lock, give_up_check);
        if (waiter.granted || waiter.displaced || !gives_up) continue;
        lock.unlock();
        given_up = gives_up();
        lock.lock();
    }
    return end_wait(queue, waiter);
}

/// Requests in the queue that have not had a time slice.
int AdmissionControl::new_waiting() const {
    return static_cast<int>(foreground_.waiting.size()) - interrupted_;
}

bool AdmissionControl::is_full() const { return new_waiting() + graces_ >= limits_.waiting; }

AdmissionControl::Slot AdmissionControl::try_acquire(const std::string& client) {
    const std::lock_guard lock(mutex_);
    if (free_ > 0) {
        --free_;
        foreground_.used += time_slice;
        return {this, {.its = &foreground_, .client = client}};
    }
    Queue& queue = foreground_.waiting;
    // Many can allocate much before their grace periods end.
    if (is_full() || graces_ >= graces_per_slot * limits_.running || uses(limits_.memory / 2) ||
        queue.has_debt(client))
        return nullptr;
    ++graces_;
    queue.charge(client, grace_time.count());
    return Slot(this);
}

AdmissionControl::Slot AdmissionControl::acquire(
    const std::string& client, const std::function<bool()>& gives_up) {
    std::unique_lock lock(mutex_);
    if (free_ == 0 && is_full()) {
        const auto is_new = [](const Waiter* waiter) { return !waiter->is_interrupted; };
        const auto is_own = [&client](const std::string& other) { return other == client; };
        Queue& queue = foreground_.waiting;
        if (const auto last = queue.pop_for(client, is_new)) (*last)->set(&Waiter::displaced);
        else if (new_waiting() >= limits_.waiting || queue.clients(is_own) > 0) return nullptr;
    }
    Waiter waiter;
    foreground_.waiting.push(client, &waiter);
    if (!wait(lock, foreground_.waiting, waiter, gives_up)) return nullptr;
    return {this, {.its = &foreground_, .client = client}};
}

AdmissionControl::Slot AdmissionControl::resume(
    const std::string& client, const std::function<bool()>& gives_up, Slot begun) {
    std::unique_lock lock(mutex_);
    const bool had_slot = !is_grace(begun);
    if (begun.release()) give_back(begun.get_deleter());
    Waiter waiter{.is_interrupted = had_slot};
    foreground_.waiting.push_before(client, &waiter, [&waiter](const Waiter* other) {
        return waiter.is_interrupted && !other->is_interrupted;
    });
    interrupted_ += had_slot;
    const bool granted = wait(lock, foreground_.waiting, waiter, gives_up);
    interrupted_ -= had_slot;
    return Slot(granted ? this : nullptr, {.its = &foreground_, .client = client});
}

AdmissionControl::Slot AdmissionControl::acquire_urgently(
    const std::string& client, const std::function<bool()>& gives_up) {
    std::unique_lock lock(mutex_);
    Waiter waiter;
    urgent_.waiting.push(client, &waiter);
    if (!wait(lock, urgent_.waiting, waiter, gives_up)) return nullptr;
    return {this, {.its = &urgent_, .client = client}};
}

bool AdmissionControl::must_yield(const Slot& background) const {
    const Release& slot = background.get_deleter();
    return (foreground_waits_ && Clock::now() >= slot.keeps_until) ||
           (background_waits_ && Clock::now() - slot.since > time_slice);
}

bool AdmissionControl::others_are_due(Slot& foreground) {
    if (!foreground_waits_ && !background_waits_) return false;
    const std::lock_guard lock(mutex_);
    count(foreground.get_deleter());
    const std::string& client = foreground.get_deleter().client;
    const auto is_other = [&client](const std::string& other) { return other != client; };
    const bool background_is_due = background_waits_ && background_.used <= foreground_.used;
    return !urgent_.waiting.empty() ||
           ((foreground_.waiting.clients(is_other) > 0 || background_is_due) && may_interrupt());
}

bool AdmissionControl::others_are_stuck(const std::string& client) const {
    if (!foreground_waits_) return false;
    const std::lock_guard lock(mutex_);
    const auto is_other = [&client](const std::string& other) { return other != client; };
    return foreground_.waiting.clients(is_other) > 0 && !may_interrupt();
}

bool AdmissionControl::may_interrupt() const {
    return interrupted_ < interrupted_per_slot * limits_.running || !uses(limits_.memory);
}

bool AdmissionControl::uses(std::size_t bytes) const {
    if (const auto now = Clock::now(); now - memory_checked_ > memory_look) {
        memory_checked_ = now;
        resident_ = process_memory().resident;
    }
    return resident_ >= bytes;
}

AdmissionControl::Slot AdmissionControl::acquire_background(
    const std::string& client, const std::stop_token& stop, const SweepSlot& sweep) {
    std::unique_lock lock(mutex_);
    Waiter waiter;
    const bool has_clients = sweep && !sweep->clients.empty();
    std::string owner = has_clients ? sweep->clients.front() : client;
    background_.waiting.push(owner, &waiter);
    assign();
    const auto is_over = [&] { return waiter.granted || sweeps_stopped_; };
    do {
        if (sweep)
            for (const std::string& other : sweep->clients)
                if (background_.waiting.move(&waiter, other)) owner = other;
        // The wait registers with the token before it checks the condition, so that no stop is
        // missed. The thread that requests the stop must not hold the mutex, and cannot.
    } while (!waiter.changed.wait_for(lock, stop, give_up_check, is_over) &&
             !stop.stop_requested());
    if (!end_wait(background_.waiting, waiter)) return nullptr;
    Slot slot(this, {.its = &background_, .client = owner});
    if (foreground_waits_) slot.get_deleter().keeps_until = Clock::now() + time_slice;
    lock.unlock();
    return sweeps_stopped_ ? nullptr : std::move(slot);
}

void AdmissionControl::release(Release& slot) {
    const std::lock_guard lock(mutex_);
    give_back(slot);
    assign();
}

/// Sweeps of a client that are not displaced.
int AdmissionControl::sweeps_of(const std::string& client) const {
    return static_cast<int>(std::ranges::count_if(sweeps_, [&client](const Sweep& sweep) {
        return std::ranges::count(sweep.clients, client) > 0 && !sweep.is_displaced;
    }));
}

AdmissionControl::SweepSlot AdmissionControl::acquire_sweep(const std::string& client) {
    const std::lock_guard lock(mutex_);
    if (sweeps_stopped_) return nullptr;
    const auto counts = [](const Sweep& sweep) { return !sweep.is_displaced; };
    if (std::ranges::count_if(sweeps_, counts) >= limits_.sweeps) {
        const auto most = [&](const Sweep& sweep) {
            int fewest = counts(sweep) && !sweep.clients.empty() ? limits_.sweeps : 0;
            for (const std::string& each : sweep.clients)
                fewest = std::min(fewest, sweeps_of(each));
            return fewest;
        };
        const auto newest = std::ranges::max_element(sweeps_, {}, most);
        if (newest == sweeps_.end() || most(*newest) < sweeps_of(client) + 2) return nullptr;
        newest->is_displaced = true;
    }
    const auto place = sweeps_.emplace(sweeps_.begin());
    return {&*place, [this, place](Sweep*) {
                const std::lock_guard ending(mutex_);
                sweeps_.erase(place);
            }};
}

std::shared_ptr<void> AdmissionControl::share(const SweepSlot& slot, const std::string& client) {
    const std::lock_guard lock(mutex_);
    return {nullptr, [this, slot, at = slot->clients.insert(slot->clients.end(), client)](void*) {
                const std::lock_guard ending(mutex_);
                slot->clients.erase(at);
            }};
}

/// False if a body finds no space in its queue, even instead of the last one.
bool AdmissionControl::make_space(Queue& queue, const std::string& client, std::size_t bytes) {
    std::size_t waiting = 0;
    queue.for_each([&waiting](const Waiter* body) { waiting += body->bytes; });
    const auto is_own = [&client](const std::string& other) { return other == client; };
    const bool is_first = queue.clients(is_own) == 0;
    const auto fits = [&](std::size_t bodies, std::size_t less) {
        return bodies == 0 || (bodies < most_waiting_bodies &&
                               (is_first || waiting - less + bytes <= most_waiting_bytes));
    };
    if (fits(queue.size(), 0)) return true;
    const auto last = queue.pop_for(
        client, [&](const Waiter* body) { return fits(queue.size() - 1, body->bytes); }, bytes);
    if (last) (*last)->set(&Waiter::displaced);
    return last.has_value();
}

AdmissionControl::SizePermit AdmissionControl::acquire_by_size(
    Lock& lock, BySize& group, const std::string& client, std::size_t bytes,
    const std::function<bool()>& gives_up) {
    Waiter waiter{.bytes = bytes};
    group.waiting.push(client, &waiter, bytes);
    if (!wait(lock, group.waiting, waiter, gives_up)) return nullptr;
    group.clients[client] += bytes;
    lock.unlock();
    return {&group, [this, &group, client, bytes, since = Clock::now()](BySize*) {
                trim_memory();
                const std::lock_guard ending(mutex_);
                const auto held = (Clock::now() - since) / std::chrono::milliseconds(1);
                group.waiting.charge(client, held * static_cast<long>(bytes >> 24));
                group.in_work -= bytes;
                if ((group.clients[client] -= bytes) == 0) group.clients.erase(client);
                assign();
            }};
}

AdmissionControl::SizePermit AdmissionControl::acquire_body(
    const std::string& client, std::size_t bytes, bool is_record,
    const std::function<bool()>& gives_up) {
    if (bytes <= immediate_body) return {&immediate_, [](BySize*) {}};
    std::unique_lock lock(mutex_);
    BySize& lesser = is_record ? lesser_records_ : lesser_bodies_;
    BySize& bodies = bytes <= lesser.at_once ? lesser : is_record ? large_records_ : large_bodies_;
    if (!make_space(bodies.waiting, client, bytes)) return nullptr;
    return acquire_by_size(lock, bodies, client, bytes, gives_up);
}

AdmissionControl::SizePermit AdmissionControl::acquire_lists(
    const std::string& client, std::size_t bytes, const std::function<bool()>& gives_up) {
    std::unique_lock lock(mutex_);
    return acquire_by_size(lock, lists_, client, bytes, gives_up);
}

bool AdmissionControl::others_need(
    const SizePermit& permit, const std::string& client, Clock::duration age,
    Clock::duration computed) const {
    if (!permit) return false;
    const BySize& group = *permit;
    const std::lock_guard lock(mutex_);
    const auto own = group.clients.find(client);
    const auto is_idle = [&](const std::string& other) { return !group.clients.contains(other); };
    const auto is_other = [&](const std::string& other) { return other != client; };
    const auto others = static_cast<int>(group.waiting.clients(is_other));
    if (own == group.clients.end() || others == 0) return false;
    const std::size_t clients = group.clients.size() + group.waiting.clients(is_idle);
    const bool is_more = own->second > std::max(group.at_once / clients, 2 * immediate_body);
    const Clock::duration most = (is_more ? 1 : 2) * std::min(group.in_need, group.round / others);
    return age > most && (computed > group.least || age > 4 * most);
}

void AdmissionControl::stop_sweeps() {
    const std::lock_guard lock(mutex_);
    sweeps_stopped_ = true;
    background_.waiting.for_each([](Waiter* waiter) { waiter->changed.notify_one(); });
}

AdmissionLoad AdmissionControl::load() const {
    const std::lock_guard lock(mutex_);
    return {
        limits_.running - free_, foreground_.waiting.size() + urgent_.waiting.size(),
        background_.waiting.size(), static_cast<int>(sweeps_.size())};
}

Permit::Permit(
    AdmissionControl& admission, std::string client, std::function<bool()> gives_up, bool may_begin,
    bool is_urgent)
    : admission_(admission),
      client_(std::move(client)),
      gives_up_(std::move(gives_up)),
      is_urgent_(is_urgent) {
    if (may_begin) slot_ = admission_.try_acquire(client_);
    if (!slot_)
        slot_ = is_urgent ? admission_.acquire_urgently(client_, gives_up_)
                          : admission_.acquire(client_, gives_up_);
}

bool Permit::renew() {
    if (!slot_) return false;
    const bool is_grace = AdmissionControl::is_grace(slot_);
    const Clock::time_point now = Clock::now();
    if (now - slot_.get_deleter().since < (is_grace ? grace_time : time_slice)) return true;
    if (!is_grace && !admission_.others_are_due(slot_)) return true;
    if (is_urgent_) slot_.reset();
    slot_ = is_urgent_ ? admission_.acquire_urgently(client_, gives_up_)
                       : admission_.resume(client_, gives_up_, std::move(slot_));
    waited_ += Clock::now() - now;
    return slot_ != nullptr;
}

bool Permit::wait_without_slot(const std::function<bool()>& wait) {
    const Clock::time_point began = Clock::now();
    slot_.reset();
    if (wait()) slot_ = admission_.acquire_urgently(client_, gives_up_);
    is_urgent_ = true;
    waited_ += Clock::now() - began;
    return slot_ != nullptr;
}

}  // namespace vines::http
