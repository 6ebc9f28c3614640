// A Modbus client as a state machine: connects, polls its table, reconnects with back-off; its values carry
// an age.
#pragma once

#include "drivers/modbus/register_map.hpp"
#include "drivers/modbus/transport.hpp"
#include "kernel/base/array_of.hpp"
#include "kernel/component/port.hpp"
#include "kernel/component/wire_counters.hpp"

#include <algorithm>
#include <utility>

namespace tappet::modbus {

enum class Quality : std::uint8_t {
    never, ///< nothing was read yet
    good,
    exception, ///< the server refuses this row; the value is the last good one
    no_number, ///< the answer is not a number; the value is the last good one
};

struct Value {
    double value = 0;
    Time stamp = Time::min(); ///< when the answer was complete
    Quality quality = Quality::never;
    std::uint8_t exception = 0;
};

struct Counters {
    std::uint64_t requests = 0;
    std::uint64_t answers = 0;
    std::uint64_t exceptions = 0;
    std::uint64_t timeouts = 0;
    std::uint64_t garbled = 0;
    std::uint64_t connects = 0;
    std::uint64_t refused = 0;
    std::uint64_t outages = 0;          ///< times the server was lost
    std::uint64_t outages_survived = 0; ///< times the server answered again after that
    std::uint64_t dropped_stale = 0;    ///< values to write that became too old before they could be sent
    std::uint64_t saturated = 0;        ///< values to write that are out of their register's range
    std::uint64_t no_numbers = 0;       ///< registers read whose value is not a number
    bool operator==(const Counters&) const = default;
};

/// A failed request and its failure. `outcome` is ok when there is none.
struct Trouble {
    std::size_t row = 0;
    Outcome outcome = Outcome::ok;
    std::uint8_t exception = 0;
    bool operator==(const Trouble&) const = default;
};

struct Backoff {
    Duration first = 100ms;
    /// Each failure doubles the wait, up to this limit. It also limits the delay until a returned server is
    /// noticed.
    Duration most = 2s;
};

/// Belongs to one activity of its own, not real-time: a step blocks for at most one request. `map` and
/// `transport` must outlive the client.
template <std::size_t R, std::size_t V> class Session {
public:
    /// `unsent`: where values that are not encoded as they were set, or are received and not a number, are
    /// counted, by their index; empty: nowhere.
    Session(const RegisterMap<R, V>& map, Transport& transport, Backoff backoff = {},
            std::span<Unsent> unsent = {}) noexcept
        : map_{&map}, transport_{&transport}, backoff_{backoff}, wait_{backoff.first}, unsent_{unsent} {}
    ~Session() { transport_->disconnect(); }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Processes what is due, at most one request, and returns when to call again.
    Time step(Time now) noexcept {
        if (now < busy_until_) return busy_until_;
        if (!connected_) return connect(now);
        const std::size_t r = most_urgent();
        if (due(r) > now) return due(r);
        const Duration every = map_->rows[r].every;
        if (due_at_[r] <= now)
            due_at_[r] = std::max(due_at_[r] + every, now + 1ns); // keeps its grid, skips missed turns
        return request(r, now);
    }

    /// The last write: sends each written row whose values were set, due or not, one after the other, and
    /// repeats once a request that gets no answer or an exception. A server lost just now is tried again; one
    /// silent for longer is skipped, because it would only block the caller. Returns false when not every
    /// safe value of the map was confirmed.
    bool finish(Time now) noexcept {
        if (outage_ && wait_ > 2 * backoff_.first) return map_->safe_count == 0;
        bool all = true;
        Time at = outage_ ? now : std::max(now, busy_until_);
        int unanswered = outage_ ? 1 : 0; // two time-outs at most, including that of the cycle before
        for (std::size_t r = 0; r < R; ++r) {
            const Row& row = map_->rows[r];
            const std::uint64_t answers = count_.answers;
            Time stamp = now;
            for (int tries = 0; row.write && tries < 2 && unanswered < 2; ++tries) {
                if (!connected_) at = connect(at);
                // Renews the stamps: none becomes too old while earlier rows or a failed attempt take time.
                for (std::size_t v = row.first; v < row.end(); ++v)
                    if (values_[v].stamp == stamp) values_[v].stamp = at;
                stamp = at;
                if (connected_) at = request(r, at);
                if (!outage_ && exception_[r] == 0) break;
                if (outage_) ++unanswered;
            }
            const bool is_written = count_.answers != answers && !outage_ && exception_[r] == 0;
            if (!is_written && has_safe_value(row) && was_set(row)) all = false;
        }
        return all;
    }

    /// Returns the value by its index in the map; its stamp shows its age.
    [[nodiscard]] const Value& value(std::size_t v) const noexcept {
        TAPPET_CONTRACT(v < V, Contract::index_out_of_range, v, V);
        return values_[v];
    }
    /// Sets a value of a written row; the row is sent once all its values were set. Returns false when the
    /// value is not a number or the row is only read.
    bool set(std::size_t v, double physical, Time now) noexcept {
        TAPPET_CONTRACT(v < V, Contract::index_out_of_range, v, V);
        const std::size_t r = map_->row_of[v];
        const Encoded encoded = to_words(map_->registers[v], physical);
        if ((encoded.refused || encoded.saturated) && v < unsent_.size())
            unsent_[v].count(encoded.saturated, encoded.refused);
        if (encoded.refused) ++count_.saturated;
        if (encoded.refused || !map_->rows[r].write) return false;
        if (encoded.saturated) ++count_.saturated;
        // An abandoned value (stamp before_all) is replaced by its safe value even if the server has it.
        if (values_[v].stamp == Time::min() || words_[v] != encoded.words || at_server_[v] == AtServer::was ||
            now == before_all) {
            changed_at_[r] = std::min(changed_at_[r], now);
            at_server_[v] = AtServer::not_yet;
        }
        words_[v] = encoded.words;
        values_[v] = {to_physical(map_->registers[v], encoded.words), now, Quality::good, 0};
        return true;
    }
    [[nodiscard]] bool connected() const noexcept TAPPET_REALTIME { return connected_; }
    /// Returns whether the server is lost: it answered once or was tried, and does not answer now.
    [[nodiscard]] bool outage() const noexcept { return outage_; }
    /// Returns what is wrong now: why the server is lost, or else the first row that it refuses.
    [[nodiscard]] Trouble trouble() const noexcept {
        if (outage_) return lost_by_;
        for (std::size_t r = 0; r < R; ++r)
            if (exception_[r] != 0) return {r, Outcome::exception, exception_[r]};
        return {};
    }
    [[nodiscard]] const Counters& counters() const noexcept TAPPET_REALTIME { return count_; }
    /// Rises with every answer: serves as "something arrived".
    [[nodiscard]] std::uint64_t generation() const noexcept { return count_.answers; }

private:
    Time connect(Time now) noexcept {
        const Answer answer = transport_->connect();
        busy_until_ = now + answer.took;
        if (answer.outcome != Outcome::ok) {
            ++count_.refused;
            return lose(now + answer.took, {most_urgent(), answer.outcome});
        }
        ++count_.connects;
        connected_ = true;
        // Rows that became due during the outage are read once, not once for each missed period.
        for (Time& due : due_at_) due = std::max(due, now);
        return busy_until_;
    }
    /// A changed row is due at the time of its change: soon, but after rows that were due earlier.
    [[nodiscard]] Time due(std::size_t r) const noexcept { return std::min(due_at_[r], changed_at_[r]); }
    [[nodiscard]] std::size_t most_urgent() const noexcept {
        std::size_t best = 0;
        for (std::size_t r = 1; r < R; ++r)
            if (due(r) < due(best)) best = r;
        return best;
    }
    Time request(std::size_t r, Time now) noexcept {
        const Row& row = map_->rows[r];
        if (row.write && !is_to_be_sent(r, now)) return now;
        const auto address = static_cast<std::uint16_t>(row.run.address);
        const auto words = std::span{buffer_}.first(row.run.count);
        if (row.write) fill(row);
        ++count_.requests;
        const Answer answer = row.write ? transport_->write(row.run.table, address, words)
                                        : transport_->read(row.run.table, address, words);
        const Time done = now + answer.took;
        busy_until_ = done;
        exception_[r] = answer.exception;
        switch (answer.outcome) {
        case Outcome::ok:
            if (!row.write)
                take(row, done);
            else
                std::ranges::fill(std::span{at_server_}.subspan(row.first, row.values), AtServer::is);
            changed_at_[r] = never;
            answered();
            return done;
        case Outcome::exception:
            for (std::size_t v = row.first; v < row.end(); ++v) {
                values_[v].quality = Quality::exception;
                values_[v].exception = answer.exception;
            }
            ++count_.exceptions;
            changed_at_[r] = never; // it would refuse again; the next period is early enough
            answered();
            return done;
        case Outcome::timeout: ++count_.timeouts; break;
        case Outcome::garbled: ++count_.garbled; break;
        case Outcome::refused:
        case Outcome::disconnected: break;
        }
        connected_ = transport_->recover();
        return lose(done, {r, answer.outcome});
    }
    [[nodiscard]] bool has_safe_value(const Row& row) const noexcept {
        return std::ranges::any_of(std::span{map_->registers}.subspan(row.first, row.values),
                                   &Register::says_safe);
    }
    /// Returns true when all values of the row were set; otherwise it was never sent.
    [[nodiscard]] bool was_set(const Row& row) const noexcept {
        return std::ranges::none_of(std::span{values_}.subspan(row.first, row.values),
                                    [](const Value& each) { return each.stamp == Time::min(); });
    }
    /// Returns whether the row is sent. Values that became too old before the server had them are replaced by
    /// safe values. A value that the server has is repeated only next to a newer one. A value that it had
    /// before an outage is then replaced by the safe value.
    bool is_to_be_sent(std::size_t r, Time now) noexcept {
        const Row& row = map_->rows[r];
        if (!was_set(row)) {
            changed_at_[r] = never;
            return false;
        }
        const auto is_old = [&](std::size_t v) {
            return values_[v].stamp == before_all ||
                   (row.stale_after > 0ns && now - values_[v].stamp > row.stale_after);
        };
        bool is_good = true;
        bool is_behind = false;
        for (std::size_t v = row.first; v < row.end(); ++v) {
            is_good = is_good && !is_old(v);
            is_behind = is_behind || at_server_[v] == AtServer::not_yet;
        }
        if (is_good) return true;
        if (!is_behind || row.silence_is_safe) {
            if (std::exchange(changed_at_[r], never) != never) ++count_.dropped_stale;
            return false;
        }
        for (std::size_t v = row.first; v < row.end(); ++v) {
            if (!is_old(v) || at_server_[v] == AtServer::is) continue;
            const Words before = words_[v];
            static_cast<void>(set(v, map_->registers[v].safe_value, now)); // in range, by the map's check
            if (words_[v] != before) ++count_.dropped_stale;
        }
        return true;
    }
    void fill(const Row& row) noexcept {
        for (std::size_t v = row.first; v < row.end(); ++v)
            for (unsigned i = 0; i < map_->registers[v].width(); ++i)
                buffer_[map_->registers[v].at + i] = words_[v][i];
    }
    void take(const Row& row, Time stamp) noexcept {
        for (std::size_t v = row.first; v < row.end(); ++v) {
            const Register& one = map_->registers[v];
            for (unsigned i = 0; i < one.width(); ++i) words_[v][i] = buffer_[one.at + i];
            if (const double value = to_physical(one, words_[v]); is_number(value)) {
                values_[v] = {value, stamp, Quality::good, 0};
            } else {
                values_[v].quality = Quality::no_number;
                ++count_.no_numbers;
                if (v < unsent_.size()) unsent_[v].count(false, true);
            }
        }
    }
    void answered() noexcept {
        ++count_.answers;
        wait_ = backoff_.first;
        if (outage_) ++count_.outages_survived;
        outage_ = false;
    }
    Time lose(Time now, const Trouble& by) noexcept {
        if (!outage_) ++count_.outages;
        for (AtServer& each : at_server_) each = std::min(each, AtServer::was);
        lost_by_ = by;
        outage_ = true;
        busy_until_ = now + wait_;
        wait_ = std::min(wait_ * 2, backoff_.most);
        return busy_until_;
    }

    const RegisterMap<R, V>* map_;
    Transport* transport_;
    Backoff backoff_;
    Duration wait_;
    std::span<Unsent> unsent_;
    Time busy_until_ = Time::min();
    bool connected_ = false;
    bool outage_ = false;
    Trouble lost_by_{};
    std::array<std::uint8_t, R> exception_{}; ///< exception code of each row's last answer; 0: none
    std::array<Time, R> due_at_{};
    std::array<Time, R> changed_at_ = array_of<R>([](std::size_t) { return never; });
    std::array<Value, V> values_{};
    std::array<Words, V> words_{};
    /// Whether the server has a value. After an outage this is unknown, since it may have restarted (`was`).
    enum class AtServer : std::uint8_t { not_yet, was, is };
    std::array<AtServer, V> at_server_{};
    std::array<std::uint16_t, most_words> buffer_{};
    Counters count_{};
    static_assert(R > 0, "a client without rows has nothing to do");
};

} // namespace tappet::modbus
