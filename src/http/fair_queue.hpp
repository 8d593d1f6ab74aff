// A queue in which clients take turns (start-time fair queueing): the first entries of all clients,
// then their second ones, and so on; among equals by cost, then arrival. A client that is charged
// loses turns.
#pragma once

#include <algorithm>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>

namespace vines::http {

template <class T>
class FairQueue {
public:
    bool empty() const { return entries_.empty(); }
    std::size_t size() const { return entries_.size(); }
    const T& front() const { return entries_.front().value; }

    void push(const std::string& client, T value, std::size_t cost = 0) {
        const long turn = last_turns_[client] = next_turn(client);
        const auto not_later = std::find_if(
            entries_.rbegin(), entries_.rend(),
            [=](const Entry& e) { return e.turn < turn || (e.turn == turn && e.cost <= cost); });
        entries_.insert(not_later.base(), {client, turn, cost, std::move(value)});
    }
    /// The client's next entries come this many turns later, unless the queue gets empty before, up
    /// to most_debt in all.
    void charge(const std::string& client, long turns) {
        if (entries_.empty()) return;
        const long last = next_turn(client) - 1;
        turns = std::min(turns, std::max(now_ + most_debt - last, 0L));
        last_turns_[client] = last + turns;
        for (Entry& e : entries_)
            if (e.client == client) e.turn += turns;
        entries_.sort([](const Entry& a, const Entry& b) {
            return std::tie(a.turn, a.cost) < std::tie(b.turn, b.cost);
        });
    }
    /// True if the client's next entry comes later than that of a client without any.
    bool has_debt(const std::string& client) const { return next_turn(client) > now_ + 1; }
    /// The same, before the client's first entry with is_later(value): these move on by one turn.
    template <class IsLater>
    void push_before(const std::string& client, T value, const IsLater& is_later) {
        push(client, {});
        bool moves = false;
        for (Entry& e : entries_)
            if (e.client == client && (moves = moves || e.value == T{} || is_later(e.value)))
                std::swap(e.value, value);
    }
    /// The entry becomes this client's, if its turn then comes earlier; returns whether it did.
    bool move(const T& value, const std::string& client) {
        const auto found = std::ranges::find(entries_, value, &Entry::value);
        if (found == entries_.end() || found->turn <= next_turn(client)) return false;
        const std::size_t cost = found->cost;
        push(client, take(found), cost);
        return true;
    }
    const std::string& last_client() const { return entries_.back().client; }
    T pop_last() { return take(std::prev(entries_.end())); }
    /// The last entry for which may(value) is true of the client that has the most of these, by
    /// cost and number; nothing if this client, with one more of this cost, would not have less.
    template <class May = bool (*)(const T&)>
    std::optional<T> pop_for(
        const std::string& client, const May& may = any, std::size_t cost = 0) {
        std::map<std::string, std::size_t> counts;
        for (const Entry& e : entries_) counts[e.client] += may(e.value) ? e.cost + 1 : 0;
        const std::size_t own = counts[client] + cost + 1;
        const auto most =
            std::ranges::max_element(counts, {}, [](const auto& c) { return c.second; });
        if (most->second <= own) return std::nullopt;
        const auto last = std::find_if(entries_.rbegin(), entries_.rend(), [&](const Entry& e) {
            return e.client == most->first && may(e.value);
        });
        return take(std::prev(last.base()));
    }
    /// The first entry whose client may(client); nothing if there is none.
    template <class May = bool (*)(const std::string&)>
    std::optional<T> pop(const May& may = any_client) {
        const auto found = std::ranges::find_if(entries_, may, &Entry::client);
        if (found == entries_.end()) return std::nullopt;
        if (found->turn > now_) {
            now_ = found->turn;
            std::erase_if(last_turns_, [this](const auto& last) { return last.second < now_; });
        }
        T value = std::move(found->value);
        entries_.erase(found);
        if (entries_.empty()) last_turns_.clear();
        return value;
    }
    void remove(const T& value) {
        const auto found = std::ranges::find(entries_, value, &Entry::value);
        if (found != entries_.end()) take(found);
    }
    /// Calls visit(value) for each entry.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (const Entry& entry : entries_) visit(entry.value);
    }
    /// Number of clients with an entry that may(client).
    template <class May>
    std::size_t clients(const May& may) const {
        std::set<std::string_view> found;
        for (const Entry& e : entries_)
            if (may(e.client)) found.insert(e.client);
        return found.size();
    }

private:
    struct Entry {
        std::string client;
        long turn = 0;
        std::size_t cost = 0;
        T value;
    };
    static constexpr long most_debt = 40'000;
    static bool any(const T&) { return true; }
    static bool any_client(const std::string&) { return true; }

    long next_turn(const std::string& client) const {
        const auto last = last_turns_.find(client);
        return last == last_turns_.end() ? now_ : std::max(now_, last->second + 1);
    }
    /// Removes an entry that had no turn.
    T take(typename std::list<Entry>::iterator entry) {
        const auto last = last_turns_.find(entry->client);
        if (last != last_turns_.end() && last->second == entry->turn) --last->second;
        T value = std::move(entry->value);
        entries_.erase(entry);
        return value;
    }

    std::list<Entry> entries_;                // in order of their turns
    std::map<std::string, long> last_turns_;  // by client, those from now_ on
    long now_ = 0;                            // turn of the last entry that had one
};

}  // namespace vines::http
