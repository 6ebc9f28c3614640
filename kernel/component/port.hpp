// Data flow ports (thesis 4.4): an output keeps the last value, an input reads it. The machine table decides
// what is between them: inside one activity nothing, across activities a wait-free data object.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/base/type_tag.hpp"
#include "kernel/component/cause.hpp"
#include "kernel/component/current.hpp"
#include "kernel/component/facet_member.hpp"
#include "kernel/component/rate_transition.hpp"
#include "kernel/component/stamps.hpp"
#include "kernel/component/stops.hpp"
#include "kernel/exchange/data_object.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

namespace tappet {

/// The state of the value that an input reads.
enum class Flow : std::uint8_t { never_written, old, fresh, stale };

/// The reader's policy for a stale value: keep it, use the row's substitute, or stop the machine.
enum class WhenStale : std::uint8_t { hold, substitute, stop };

/// A value that a table's row gives: a number, or a constant with static storage.
struct RowValue {
    bool given = false;
    double number = 0;
    const void* constant = nullptr;
    TypeId type = nullptr; ///< of the constant
};

/// The input's part of a connection's row.
struct InputPolicy {
    Duration max_age{}; ///< 0: no value is ever stale
    WhenStale when_stale = WhenStale::hold;
    RowValue substitute{};
    RowValue before_first{};
    double scale = 1;                 ///< for a floating number that comes from another data object
    BetweenValues* between = nullptr; ///< for the same; null: the last value is held
    bool is_cause = false; ///< a new value's stamp is the cause of what its reader does in that cycle
};

/// For an input: the factor of each new value, and the values between two. Only floating numbers have them.
struct Scale {
    double factor = 1;
    BetweenValues* between = nullptr;
};
struct NoScale {};

/// A value and the time at which it was true.
template <class T>
struct Sample {
    T value = default_value<T>();
    Time stamp{};
    Life life = never_lived; ///< life of its writer, as the writer wrote it
};

template <class T>
inline constexpr bool copied_as_bytes<Sample<T>> = copied_as_bytes<T>;

/// Alignment of the contents of a port: a larger value begins on a cache line, so that it touches no more
/// lines than it must.
template <class T>
inline constexpr std::size_t place_alignment = std::max(alignof(T), std::size_t{sizeof(T) < 96 ? 1 : 64});

/// Addresses of a port's contents for an observer; null: there is none. They change only in the port's own
/// activity.
struct PortPlaces {
    const void* value = nullptr;
    const Time* stamp = nullptr;
    const std::uint64_t* writes = nullptr; ///< number of values so far
    const bool* forced = nullptr;
    const void* forced_value = nullptr; ///< for an input, while it is forced
};

/// A place to wake: the engine of an activity that a connection row wakes.
struct Waker {
    void (*wake)(void*) noexcept TAPPET_REALTIME = nullptr;
    void* context = nullptr;
    void operator()() const noexcept TAPPET_REALTIME {
        if (wake != nullptr) wake(context);
    }
};

/// A filter that each written value passes, in the port's own activity; it may change the value.
struct PortFilter {
    void (*pass)(PortFilter& self, void* value, Time stamp) noexcept TAPPET_REALTIME = nullptr;
};

/// Counts dropped writes; not null: the component does not run.
using DroppedWrites = std::atomic<std::uint32_t>;

/// The clock of a port before its machine connects the ports of the component's interface.
inline constexpr Time no_clock{};

/// An output port. Written only by its own component, from its own activity. From the end of the component's
/// stop() to its next start() a write is dropped and counted: the values that stop() left stay. Real-time.
template <class T>
class Output : FacetMember<member::port> {
    static_assert(Exchangeable<T>, "what flows between activities is copied word by word");

public:
    using Value = T;

    /// Writes a value that is true now, at the time of the cycle.
    void write(const T& value) noexcept TAPPET_REALTIME { put(value, *now_); }
    /// Writes a value that was true at `stamp`. A stamp more than ahead_at_most after the cycle's time is
    /// impossible, and such a value counts as old as can be.
    void write(const T& value, Time stamp) noexcept TAPPET_REALTIME {
        put(value, judged_stamp(stamp, *now_));
    }
    /// Returns the value that the component wrote last, also while readers get a forced value instead.
    [[nodiscard]] const T& last() const noexcept TAPPET_REALTIME { return forced_ ? hidden_ : last_.value; }

private:
    template <class>
    friend class Input;
    friend struct PortAccess;

    void put(const T& value, Time stamp) noexcept TAPPET_REALTIME {
        TAPPET_THREAD_CONTRACT(runs_by(now_), Contract::single_writer, running_activity());
        if (!inside_only_) return write_further(value, stamp);
        last_.value = value;
        last_.stamp = stamp;
        ++generation_;
    }
    [[gnu::noinline]] void write_further(const T& value, Time stamp) noexcept TAPPET_REALTIME {
        if (dropped_ != nullptr) [[unlikely]] {
            dropped_->fetch_add(1, std::memory_order_relaxed); // no step: counted for the report
            return;
        }
        if constexpr (std::is_arithmetic_v<T>)
            if (filter_ != nullptr) [[unlikely]] {
                T passed = value; // observers see only what passed
                filter_->pass(*filter_, &passed, std::min(stamp, *now_));
                return store(passed, stamp);
            }
        store(value, stamp);
    }
    void store(const T& value, Time stamp) noexcept TAPPET_REALTIME {
        last_.stamp = stamp;
        if (forced_) [[unlikely]] {
            hidden_ = value;
            hidden_stamp_ = stamp;
            hidden_life_ = life_;
        } else {
            copy_value(value, last_.value);
        }
        publish(life_);
    }
    /// Updates the fast path's condition, after each change of what a write depends on.
    void settle() noexcept TAPPET_REALTIME {
        inside_only_ = !forced_ && dropped_ == nullptr && shared_ == nullptr && waker_.wake == nullptr &&
                       filter_ == nullptr && last_.life == life_;
    }
    void publish(Life life) noexcept TAPPET_REALTIME {
        ++generation_;
        if (last_.life != life) [[unlikely]] {
            last_.life = life;
            settle();
        }
        if (shared_ != nullptr) shared_->write(last_);
        waker_();
    }
    /// The component begins to stop.
    void begin_life(Life next) noexcept TAPPET_REALTIME {
        life_ = next;
        settle();
    }
    /// Forces a value, in the port's own activity, between two steps. Returns false, and forces nothing, when
    /// its component never wrote the port: a release would have to invent a value.
    bool force(const T& value) noexcept TAPPET_REALTIME {
        if (last_.life == never_lived) return false;
        if (!forced_) {
            hidden_ = last_.value;
            hidden_stamp_ = last_.stamp;
            hidden_life_ = last_.life;
        }
        forced_ = true;
        settle();
        last_.value = value;
        last_.stamp = *now_;
        publish(life_);
        return true;
    }
    /// Publishes what the component wrote last, before the force or meanwhile, with its own time stamp.
    void release() noexcept TAPPET_REALTIME { show_hidden(hidden_life_); }
    /// Ends the force because its component has stopped. A hidden value that was not written in that stop is
    /// abandoned; see Input::is_abandoned().
    void end_force() noexcept TAPPET_REALTIME { show_hidden(hidden_life_ == life_ ? life_ : unwanted); }
    void show_hidden(Life life) noexcept TAPPET_REALTIME {
        if (!forced_) return;
        forced_ = false;
        settle();
        last_.value = hidden_;
        last_.stamp = hidden_stamp_;
        publish(life);
    }

    alignas(place_alignment<Sample<T>>) Sample<T> last_{};
    std::uint64_t generation_ = 0;
    const Time* now_ = &no_clock;
    bool inside_only_ = false; ///< only readers of its own activity, and the value is the component's
    bool forced_ = false;
    DataObject<Sample<T>>* shared_ = nullptr;
    Waker waker_{};
    PortFilter* filter_ = nullptr;
    DroppedWrites* dropped_ = nullptr;
    alignas(place_alignment<T>) T hidden_ =
        default_value<T>(); ///< of a forced port: the value that its component wrote
    Time hidden_stamp_{};   ///< and the time at which it was true
    Life hidden_life_ = never_lived;
    Life life_ = first_life; ///< of the values that its component writes
};

/// An input port. Read only by its own component, from its own activity. Real-time.
template <class T>
class Input : FacetMember<member::port> {
public:
    using Value = T;

    /// Copies the value into `into` and returns its state. If never written, it gives the row's value before
    /// the first one, or the row's substitute, or zero.
    Flow read(T& into) noexcept TAPPET_REALTIME {
        TAPPET_THREAD_CONTRACT(runs_by(now_), Contract::single_reader, running_activity());
        if (!inside_only_ || local_->last_.life < first_life) return read_further(into);
        into = local_->last_.value;
        const std::uint64_t seen = seen_;
        seen_ = local_->generation_;
        return seen == seen_ ? Flow::old : Flow::fresh;
    }
    /// Returns the value alone, with the row's staleness policy applied.
    [[nodiscard]] T get() noexcept TAPPET_REALTIME {
        TAPPET_THREAD_CONTRACT(runs_by(now_), Contract::single_reader, running_activity());
        if (!inside_only_ || local_->last_.life < first_life) return get_further();
        seen_ = local_->generation_;
        return local_->last_.value;
    }
    /// Returns the time at which the value read last was true: now for a forced value, before all for an
    /// abandoned one. It is never later than the first look at the value: a time ahead does not keep a value
    /// valid for longer.
    [[nodiscard]] Time stamp() const noexcept TAPPET_REALTIME {
        return forced_ ? *now_ : is_abandoned() ? before_all : true_at();
    }
    /// Returns the time as its writer stated it, also when it is ahead.
    [[nodiscard]] Time claimed_stamp() const noexcept TAPPET_REALTIME {
        return forced_ ? *now_ : local_ != nullptr ? local_->last_.stamp : cache_.stamp;
    }
    /// Returns the state of the value without copying it; a fresh value stays fresh for read().
    [[nodiscard]] Flow flow() noexcept TAPPET_REALTIME { return look(least_life_); }
    /// Returns whether there is a value that is not stale: get() can be relied on.
    [[nodiscard]] bool good() noexcept TAPPET_REALTIME {
        const Flow now = flow();
        return now == Flow::fresh || now == Flow::old;
    }
    /// Returns when the value read last becomes stale if nothing newer comes, or if nothing came at all;
    /// never: it does not become stale.
    [[nodiscard]] Time expires() const noexcept TAPPET_REALTIME {
        if (max_age_ == Duration::zero()) return never;
        return (forced_ || life() == never_lived ? *now_ : true_at()) + max_age_ + 1ns;
    }
    [[nodiscard]] bool connected() const noexcept TAPPET_REALTIME {
        return local_ != nullptr || shared_ != nullptr;
    }
    /// Returns whether a force ended with a stop, and the value at the other end is still the one that it
    /// hid: then nobody wants that value any longer. It is stale, and was true before all; readers that act
    /// on stale values must check this. Call it after read().
    [[nodiscard]] bool is_abandoned() const noexcept TAPPET_REALTIME {
        return !forced_ && life() != never_lived && life() < least_life_;
    }
    /// Returns how many values reached the other end until the one read last; for a forced input until now.
    [[nodiscard]] std::uint64_t writes() const noexcept TAPPET_REALTIME {
        return before_turn_ + (forced_ ? written() : generation());
    }
    /// Returns whether its row substitutes stale values: the substitute is true now.
    [[nodiscard]] bool has_substitute() const noexcept TAPPET_REALTIME {
        return when_stale_ == WhenStale::substitute;
    }
    /// Returns whether its component gets a forced value in place of what is written.
    [[nodiscard]] bool forced() const noexcept TAPPET_REALTIME { return forced_; }

private:
    friend struct PortAccess;

    [[gnu::noinline]] Flow read_further(T& into) noexcept TAPPET_REALTIME {
        if (fetch() && max_age_ == Duration::zero() && cache_.life >= least_life_) {
            // From the registers into which the value was just loaded.
            copy_value(cache_.value, into);
            seen_ = cached_generation_;
            return Flow::fresh;
        }
        const Flow flow = judge(least_life_);
        into = value_of(flow);
        return flow;
    }
    /// Returns the state of the value; one of an earlier life than `least` is stale.
    Flow look(Life least) noexcept TAPPET_REALTIME {
        const std::uint64_t seen = seen_;
        static_cast<void>(fetch());
        const Flow now = judge(least);
        seen_ = seen;
        return now;
    }
    [[gnu::noinline]] T get_further() noexcept TAPPET_REALTIME { return value_of(refresh()); }
    Flow refresh() noexcept TAPPET_REALTIME {
        TAPPET_THREAD_CONTRACT(runs_by(now_), Contract::single_reader, running_activity());
        static_cast<void>(fetch());
        return judge(least_life_);
    }
    /// Gets a newer value from another activity. Returns true when there was one. A read that lost against a
    /// fast writer leaves the last good value, which is then old; a read after a force leaves the forced
    /// value, stale.
    [[gnu::always_inline]] bool fetch() noexcept TAPPET_REALTIME {
        if (forced_ && writer_has_stopped()) {
            end_force();
            if (writer_->forced != nullptr) writer_->forced->fetch_sub(1, std::memory_order_relaxed);
        }
        if (shared_ == nullptr || forced_) return false;
        const Life before = cache_.life;
        const bool is_new = shared_->read(cache_, cached_generation_);
        if (is_new && is_cause_) note_cause(cache_.stamp);
        if constexpr (std::is_floating_point_v<T>) {
            if (is_new && scale_.factor != 1) cache_.value = scaled(cache_.value);
            if (scale_.between != nullptr && cached_generation_ != 0) [[unlikely]]
                cache_.value = static_cast<T>(scale_.between->at(
                    *now_, is_new, static_cast<double>(cache_.value), true_at(), cache_.life != before));
        }
        return is_new;
    }
    Flow judge(Life least) noexcept TAPPET_REALTIME {
        if (forced_) [[unlikely]] {
            const bool is_new = seen_ != forced_generation;
            seen_ = forced_generation;
            return is_new ? Flow::fresh : Flow::old;
        }
        const std::uint64_t generation = this->generation();
        if (life() == never_lived) return Flow::never_written;
        if (life() < least) [[unlikely]]
            return Flow::stale;
        if (max_age_ > Duration::zero() && *now_ - true_at() > max_age_) return Flow::stale;
        if (generation == seen_) return Flow::old;
        seen_ = generation;
        return Flow::fresh;
    }
    /// Updates the fast path's condition, after each change of what a read depends on.
    void settle() noexcept TAPPET_REALTIME {
        least_life_ = local_ == abandoned_of_ ? wanted_from_ : first_life;
        if (stands_ && local_ == hides_of_) least_life_ = std::max(least_life_, life_after(stops_before_));
        inside_only_ =
            local_ != nullptr && !forced_ && max_age_ == Duration::zero() && least_life_ == first_life;
    }
    [[nodiscard]] const T& value_of(Flow flow) const noexcept TAPPET_REALTIME {
        if (flow == Flow::never_written) return before_first_;
        if (flow == Flow::stale && when_stale_ == WhenStale::substitute) return substitute_;
        return local_ != nullptr && !forced_ ? local_->last_.value : cache_.value;
    }
    /// Links the output that writes it from now on, by turns. A forced value stays, and still belongs to the
    /// writer before: the turn may be refused to the new one.
    void link(const Output<T>* output, const Stops* writer) noexcept TAPPET_REALTIME {
        linked_ = writer;
        turned_from_ = local_ != output ? local_ : nullptr;
        if (!forced_)
            seen_ = 0;
        else
            ends_before_turn_ = writer_has_stopped();
        local_ = output;
        settle();
    }
    /// Gives the turn to that writer: the force ends with that one's stop, unless the writer before had
    /// stopped by itself when the input was linked.
    void hand_force_to(const Stops* writer) noexcept TAPPET_REALTIME {
        if (turned_from_ != nullptr) before_turn_ += turned_from_->generation_;
        turned_from_ = nullptr;
        if (forced_ && !ends_before_turn_) hide_from(writer);
    }
    /// Starts to hide the writer's values: those written so far, and until it begins to stop.
    void hide_from(const Stops* writer) noexcept TAPPET_REALTIME {
        writer_ = writer;
        stops_before_ = stops_of_writer();
        hides_of_ = local_;
        ends_before_turn_ = false;
    }
    /// Forces a value, in the port's own activity, between two steps. Whatever comes, the component reads
    /// this value, fresh once and never stale, until it is released or its writer stops: then the writer's
    /// safe values count; see is_abandoned().
    bool force(const T& value) noexcept TAPPET_REALTIME {
        if (forced_ && writer_has_stopped()) end_force();
        resume(); // by the values that it wants now
        hide_from(linked_);
        cache_ = {value, *now_};
        seen_ = 0;
        forced_ = true;
        settle();
        return true;
    }
    /// Ends the force, with the stop of its writer or of its own component, whichever is first. In the second
    /// case, values of a writer that does not stop are wanted again when the component starts.
    [[gnu::noinline, gnu::cold]] void end_force() noexcept TAPPET_REALTIME {
        if (!forced_) return;
        stands_ = true;
        if (writer_has_stopped()) resume();
        let_go();
    }
    /// Ends the force at its owner's request: the writer's values count again, if it has not stopped since.
    void release() noexcept TAPPET_REALTIME {
        if (!forced_) return;
        if (writer_has_stopped()) return end_force();
        let_go();
    }
    /// The component starts again.
    void resume() noexcept TAPPET_REALTIME {
        if (!std::exchange(stands_, false)) return;
        if (life_after(stops_of_writer()) != life_after(stops_before_)) {
            abandoned_of_ = hides_of_;
            wanted_from_ = life_after(stops_before_);
        }
        settle();
    }
    void let_go() noexcept TAPPET_REALTIME {
        forced_ = false;
        settle();
        seen_ = cached_generation_ = 0; // the value at the other end is read again
        cache_ = {};
    }

    /// Returns the number of the value that was read last, if it is not forced; 0: there is none.
    [[nodiscard]] std::uint64_t generation() const noexcept TAPPET_REALTIME {
        return local_ != nullptr ? local_->generation_ : cached_generation_;
    }
    [[nodiscard]] Life life() const noexcept TAPPET_REALTIME {
        return local_ != nullptr ? local_->last_.life : cache_.life;
    }
    [[nodiscard]] std::uint64_t written() const noexcept TAPPET_REALTIME {
        return local_ != nullptr ? local_->generation_ : shared_ != nullptr ? shared_->generation() : 0;
    }
    [[nodiscard]] Time true_at() const noexcept TAPPET_REALTIME {
        const Time stamp = local_ != nullptr ? local_->last_.stamp : cache_.stamp;
        const bool is_ahead = stamp > *now_ + arrives_within;
        const bool was_ahead = stamp == ahead_ && (is_ahead || generation() == ahead_of_);
        if (!is_ahead && !was_ahead) [[likely]]
            return stamp;
        if (!was_ahead) ahead_ = stamp, ahead_of_ = generation(), seen_ahead_at_ = *now_;
        return seen_ahead_at_;
    }
    [[nodiscard]] bool writer_has_stopped() const noexcept TAPPET_REALTIME {
        return stops_of_writer() != stops_before_;
    }
    [[nodiscard]] std::uint64_t stops_of_writer() const noexcept TAPPET_REALTIME {
        return writer_ == nullptr ? 0 : writer_->count.load(std::memory_order_acquire);
    }
    /// Converts into the unit of the reader. A value too large for T becomes its largest one; NaN and
    /// infinity stay.
    [[nodiscard]] T scaled(T value) const noexcept TAPPET_REALTIME
        requires std::is_floating_point_v<T>
    {
        constexpr double most = std::numeric_limits<T>::max();
        const double wanted = static_cast<double>(value) * scale_.factor;
        return is_number(value) ? static_cast<T>(std::clamp(wanted, -most, most)) : value;
    }

    static constexpr std::uint64_t forced_generation = ~std::uint64_t{0};

    alignas(place_alignment<Sample<T>>) Sample<T> cache_{};
    std::uint64_t cached_generation_ = 0;
    const DataObject<Sample<T>>* shared_ = nullptr;
    [[no_unique_address]] std::conditional_t<std::is_floating_point_v<T>, Scale, NoScale> scale_{};
    bool inside_only_ = false; ///< the value is the one at the other end, of any age
    bool forced_ = false, is_cause_ = false;
    bool stands_ = false;           ///< its component is stopped, and a force ended with that stop
    bool ends_before_turn_ = false; ///< the writer had stopped when another one was linked
    WhenStale when_stale_ = WhenStale::hold;
    std::uint64_t seen_ = 0;
    const Output<T>* local_ = nullptr;
    const Stops* linked_ = nullptr;           ///< of the component that writes the other end
    const Stops* writer_ = nullptr;           ///< of the component with whose stop a force ends
    const Output<T>* hides_of_ = nullptr;     ///< the output whose values a force hides
    const Output<T>* abandoned_of_ = nullptr; ///< the output whose values are abandoned when they are ..
    Life wanted_from_ = first_life;           ///< .. of an earlier life than this
    std::uint64_t stops_before_ = 0;          ///< of writer_, when the force began
    Life least_life_ = first_life;            ///< least life of wanted values of the present writer
    const Output<T>* turned_from_ = nullptr;  ///< until the turn is accepted
    std::uint64_t before_turn_ = 0;           ///< number of values that other writers had written
    mutable Time ahead_{}, seen_ahead_at_{};  ///< the last stamp that was ahead, and when it was seen first
    mutable std::uint64_t ahead_of_ = 0;      ///< the number of that value
    Duration max_age_{};
    const Time* now_ = &no_clock;
    alignas(place_alignment<T>) T substitute_ = default_value<T>();
    alignas(place_alignment<T>) T before_first_ = default_value<T>();
};

} // namespace tappet
