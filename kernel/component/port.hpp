// Data flow ports (thesis 4.4): an output keeps the last value, an input reads it. What stands between them
// is decided by the machine table: inside one activity nothing, across activities a wait-free data object.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/base/type_tag.hpp"
#include "kernel/exchange/data_object.hpp"

#include <cstdint>
#include <type_traits>

namespace tappet {

/// What reading an input tells about the value.
enum class Flow : std::uint8_t { never_written, old, fresh, stale };

/// What a stale value means for the reader: keep it, use the row's substitute, or stop the machine.
enum class WhenStale : std::uint8_t { hold, substitute, stop };

/// A value that a table's row gives: a number, or a constant with static storage.
struct RowValue {
    bool given = false;
    double number = 0;
    const void* constant = nullptr;
    TypeId type = nullptr; ///< of the constant
};

/// What a connection's row says to the input.
struct InputPolicy {
    Duration max_age{}; ///< 0: no value is ever stale
    WhenStale when_stale = WhenStale::hold;
    RowValue substitute{};
    RowValue before_first{};
};

/// A value and the time it was true.
template <class T>
struct Sample {
    T value = default_value<T>();
    Time stamp{};
};

template <class T>
inline constexpr bool copied_as_bytes<Sample<T>> = copied_as_bytes<T>;

/// Where an observer finds what a port holds; null where there is nothing. They change in the port's own
/// activity only.
struct PortPlaces {
    const void* value = nullptr;
    const Time* stamp = nullptr;
    const std::uint64_t* writes = nullptr; ///< how many values came so far
    const bool* forced = nullptr;
    const void* forced_value = nullptr; ///< an input's, while it is forced
};

/// A place to wake: the engine of an activity that a connection row wakes.
struct Waker {
    void (*wake)(void*) noexcept TAPPET_REALTIME = nullptr;
    void* context = nullptr;
    void operator()() const noexcept TAPPET_REALTIME {
        if (wake != nullptr) wake(context);
    }
};

/// An output port. Written by its own component only, from its own activity. Real-time.
template <class T>
class Output {
    static_assert(Exchangeable<T>, "what flows between activities is copied word by word");

public:
    using Value = T;

    /// Writes a value that is true now, at the time of the cycle.
    void write(const T& value) noexcept TAPPET_REALTIME { write(value, *now_); }
    /// Writes a value that was true at `stamp`.
    void write(const T& value, Time stamp) noexcept TAPPET_REALTIME {
        if (forced_)
            hidden_ = value;
        else
            last_.value = value;
        last_.stamp = stamp;
        publish();
    }
    /// What the component wrote last, also while readers get a forced value instead.
    [[nodiscard]] const T& last() const noexcept TAPPET_REALTIME { return forced_ ? hidden_ : last_.value; }

private:
    template <class>
    friend class Input;
    friend struct PortAccess;

    void publish() noexcept TAPPET_REALTIME {
        ++generation_;
        if (shared_ != nullptr) shared_->write(last_);
        waker_();
    }
    /// In the port's own activity, between two steps.
    void force(const T& value) noexcept TAPPET_REALTIME {
        if (!forced_) hidden_ = last_.value;
        forced_ = true;
        last_ = {value, *now_};
        publish();
    }
    /// What the component wrote last, be it before or meanwhile, is published again.
    void release() noexcept TAPPET_REALTIME {
        if (!forced_) return;
        forced_ = false;
        last_ = {hidden_, *now_};
        publish();
    }

    Sample<T> last_{};
    T hidden_ = default_value<T>(); ///< of a forced port: what its component wrote
    bool forced_ = false;
    std::uint64_t generation_ = 0;
    DataObject<Sample<T>>* shared_ = nullptr;
    const Time* now_ = &detail_epoch;
    Waker waker_{};

    static constexpr Time detail_epoch{};
};

/// An input port. Read by its own component only, from its own activity. Real-time.
template <class T>
class Input {
public:
    using Value = T;

    /// Copies the value into `into` and tells what it is. Never written: what the row gives before the first
    /// value, or its substitute, or zero.
    Flow read(T& into) noexcept TAPPET_REALTIME {
        const Flow flow = refresh();
        into = value_of(flow);
        return flow;
    }
    /// The value alone, with the row's staleness policy applied.
    [[nodiscard]] T get() noexcept TAPPET_REALTIME { return value_of(refresh()); }
    /// When the value read last was true.
    [[nodiscard]] Time stamp() const noexcept TAPPET_REALTIME {
        return local_ != nullptr && !forced_ ? local_->last_.stamp : cache_.stamp;
    }
    /// Tells what the value is, without copying it out; a fresh value stays fresh for read().
    [[nodiscard]] Flow flow() noexcept TAPPET_REALTIME {
        const std::uint64_t seen = seen_;
        const Flow now = refresh();
        seen_ = seen;
        return now;
    }
    [[nodiscard]] bool connected() const noexcept TAPPET_REALTIME {
        return local_ != nullptr || shared_ != nullptr;
    }

private:
    friend struct PortAccess;

    Flow refresh() noexcept TAPPET_REALTIME {
        std::uint64_t generation = 0;
        if (forced_) {
            const bool is_new = seen_ != forced_generation;
            seen_ = forced_generation;
            return is_new ? Flow::fresh : Flow::old;
        }
        if (local_ != nullptr) {
            generation = local_->generation_;
        } else if (shared_ != nullptr) {
            // A read that lost against a fast writer leaves the last good value, which is then old.
            if (!shared_->read(cache_, cached_generation_) && cached_generation_ == 0)
                return Flow::never_written;
            generation = cached_generation_;
        }
        if (generation == 0) return Flow::never_written;
        if (max_age_ > Duration::zero() && *now_ - stamp() > max_age_) return Flow::stale;
        if (generation == seen_) return Flow::old;
        seen_ = generation;
        return Flow::fresh;
    }
    [[nodiscard]] const T& value_of(Flow flow) const noexcept TAPPET_REALTIME {
        if (flow == Flow::never_written) return before_first_;
        if (flow == Flow::stale && when_stale_ == WhenStale::substitute) return substitute_;
        return local_ != nullptr && !forced_ ? local_->last_.value : cache_.value;
    }
    /// In the port's own activity, between two steps. The component reads this value, whatever comes: fresh
    /// once, never stale.
    void force(const T& value) noexcept TAPPET_REALTIME {
        cache_ = {value, *now_};
        seen_ = 0;
        forced_ = true;
    }
    void release() noexcept TAPPET_REALTIME {
        if (!forced_) return;
        forced_ = false;
        seen_ = cached_generation_ = 0; // what stands at the other end is read again
        cache_ = {};
    }

    static constexpr std::uint64_t forced_generation = ~std::uint64_t{0};

    const Output<T>* local_ = nullptr;
    const DataObject<Sample<T>>* shared_ = nullptr;
    const Time* now_ = &Output<T>::detail_epoch;
    Duration max_age_{};
    WhenStale when_stale_ = WhenStale::hold;
    bool forced_ = false;
    std::uint64_t seen_ = 0;
    std::uint64_t cached_generation_ = 0;
    Sample<T> cache_{};
    T substitute_ = default_value<T>();
    T before_first_ = default_value<T>();
};

} // namespace tappet
