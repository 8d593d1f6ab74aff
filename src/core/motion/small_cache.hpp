// Cache for tables that take longer to compute than to use once.
#pragma once

#include <array>
#include <memory>

namespace vines {

/// Caches a pure function of a few numbers for its most recent keys; a new entry replaces the
/// oldest. Declare it thread_local: no lock, and a thread's results do not depend on other threads.
template <class Key, class Table, std::size_t most = 4>
class SmallCache {
public:
    template <class Make>
    std::shared_ptr<const Table> get(const Key& key, Make make) {
        for (const Entry& e : entries_)
            if (e.table && e.key == key) return e.table;
        Entry& oldest = entries_[next_++ % most];
        oldest = {key, std::make_shared<const Table>(make())};
        return oldest.table;
    }

private:
    struct Entry {
        Key key;
        std::shared_ptr<const Table> table;
    };
    std::array<Entry, most> entries_;
    std::size_t next_ = 0;
};

}  // namespace vines
