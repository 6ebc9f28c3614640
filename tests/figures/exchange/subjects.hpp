// The measured subjects: each gives a packet on one side and takes it on the other. The last value: taking
// returns whether there is a new one. The queue: it delivers each packet once; giving returns whether there
// was room.
#pragma once

#include "tests/figures/exchange/machine.hpp"
#include "tests/figures/measure/candidates.hpp"
#include "tests/figures/measure/inheriting_mutex.hpp"

#include <atomic>
#include <boost/lockfree/queue.hpp>
#include <boost/lockfree/spsc_queue.hpp>
#include <mutex>

namespace tappet::figures {

/// The hardware's limit for handing over one packet: a copy in, a flag, a copy out. It protects nothing.
template <std::size_t bytes, bool flag_on_its_own_line>
struct BareHandOver {
    static constexpr const char* name =
        flag_on_its_own_line ? "bare loop, flag on a line of its own" : "bare loop, flag beside the data";
    static constexpr Standing role = Standing::floor;

    static bool give(const Packet<bytes>& value) noexcept {
        place.value = value;
        clobber();
        place.flag.store(++given, std::memory_order_release);
        return true;
    }
    static bool take(Packet<bytes>& into) noexcept {
        const std::uint64_t flag = place.flag.load(std::memory_order_acquire);
        if (flag == taken) return false;
        clobber();
        into = place.value;
        taken = flag;
        return true;
    }

private:
    struct alignas(128) Place {
        Packet<bytes> value{};
        alignas(flag_on_its_own_line ? 128 : 8) std::atomic<std::uint64_t> flag{0};
    };
    static inline Place place{};
    alignas(128) static inline std::uint64_t given = 0;
    alignas(128) static inline std::uint64_t taken = 0;
};

/// Whether the reader is in the writer's activity (near) or in another (far).
enum class Reach : std::uint8_t { near, far };

template <std::size_t bytes, Reach reach>
struct Port {
    static constexpr const char* name =
        reach == Reach::near ? "Tappet data port, same activity" : "Tappet data port";
    static constexpr Standing role = Standing::ours;
    static bool give(const Packet<bytes>& value) noexcept {
        (reach == Reach::near ? Ends<bytes>::writer->near : Ends<bytes>::writer->far).write(value);
        return true;
    }
    static bool take(Packet<bytes>& into) noexcept {
        return (reach == Reach::near ? Ends<bytes>::near : Ends<bytes>::far)->last.read(into) == Flow::fresh;
    }
};

template <std::size_t bytes, Reach reach>
struct Buffer {
    static constexpr const char* name =
        reach == Reach::near ? "Tappet buffer port, same activity" : "Tappet buffer port";
    static constexpr Standing role = Standing::ours;
    static bool give(const Packet<bytes>& value) noexcept {
        return (reach == Reach::near ? Ends<bytes>::writer->near_each : Ends<bytes>::writer->far_each)
            .push(value);
    }
    static bool take(Packet<bytes>& into) noexcept {
        return (reach == Reach::near ? Ends<bytes>::near : Ends<bytes>::far)->each.pop(into);
    }
};

/// POSIX mutexes.
struct PlainLock : std::mutex {
    static constexpr const char* name = "std::mutex";
};
struct InheritingLock : InheritingMutex {
    static constexpr const char* name = "mutex with priority inheritance";
};

template <std::size_t bytes, class Lock>
struct LockedValue {
    static constexpr const char* name = Lock::name;
    static constexpr Standing role = Standing::peer;
    static bool give(const Packet<bytes>& value) noexcept {
        const std::lock_guard guard{lock};
        held = value;
        ++written;
        return true;
    }
    static bool take(Packet<bytes>& into) noexcept {
        const std::lock_guard guard{lock};
        if (written == seen) return false;
        into = held;
        seen = written;
        return true;
    }

private:
    alignas(128) static inline Lock lock{};
    static inline Packet<bytes> held{};
    static inline std::uint64_t written = 0;
    static inline std::uint64_t seen = 0;
};

template <std::size_t bytes, class Lock>
struct LockedQueue {
    static constexpr const char* name = Lock::name;
    static constexpr Standing role = Standing::peer;
    static bool give(const Packet<bytes>& value) noexcept {
        const std::lock_guard guard{lock};
        if (pushed - popped == queue_places) return false;
        places[pushed++ % queue_places] = value;
        return true;
    }
    static bool take(Packet<bytes>& into) noexcept {
        const std::lock_guard guard{lock};
        if (pushed == popped) return false;
        into = places[popped++ % queue_places];
        return true;
    }

private:
    alignas(128) static inline Lock lock{};
    static inline std::array<Packet<bytes>, queue_places> places{};
    static inline std::size_t pushed = 0, popped = 0;
};

template <std::size_t bytes>
struct BoostSpsc {
    static constexpr const char* name = "boost::lockfree::spsc_queue";
    static constexpr Standing role = Standing::peer;
    static bool give(const Packet<bytes>& value) noexcept { return queue.push(value); }
    static bool take(Packet<bytes>& into) noexcept { return queue.pop(into); }

private:
    using Queue = boost::lockfree::spsc_queue<Packet<bytes>, boost::lockfree::capacity<queue_places>>;
    alignas(128) static inline Queue queue{};
};

template <std::size_t bytes>
struct BoostQueue {
    static constexpr const char* name = "boost::lockfree::queue";
    static constexpr Standing role = Standing::peer;
    static bool give(const Packet<bytes>& value) noexcept { return queue.bounded_push(value); }
    static bool take(Packet<bytes>& into) noexcept { return queue.pop(into); }

private:
    using Queue = boost::lockfree::queue<Packet<bytes>, boost::lockfree::capacity<queue_places>>;
    alignas(128) static inline Queue queue{};
};

} // namespace tappet::figures
