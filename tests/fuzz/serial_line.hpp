// A serial line with a time of its own, and a Modbus server at its far end that answers as the input says.
// The linker replaces the system calls of libmodbus by the functions here: exactly one source file of a
// program includes this header.
#pragma once

#include "tests/drivers/modbus/raw_server.hpp"

#include "kernel/base/time.hpp"
#include "tests/fuzz/input.hpp"

#include <deque>

#include <fcntl.h>
#include <sys/select.h>
#include <time.h>

namespace tappet::fuzz {

using modbus::Bytes;

inline void seal(Bytes& frame) {
    const std::uint16_t crc = modbus::checksum(frame, frame.size());
    frame.push_back(static_cast<std::uint8_t>(crc & 0xFF));
    frame.push_back(static_cast<std::uint8_t>(crc >> 8));
}

struct Line {
    Script script{};
    Time now{}, asked_at{}, first_taken_at{};
    int terminal = -1; ///< open in libmodbus
    std::deque<std::pair<Time, std::uint8_t>> coming{};
    Bytes asked{}, taken{}, before{};
    std::uint8_t questions = 0;

    Bytes next(std::size_t most) {
        const auto part = script.next(most);
        return {part.begin(), part.end()};
    }
    /// The answer of a correct server; each question has other values.
    [[nodiscard]] Bytes right() const {
        if (asked[1] > 4) return {asked.begin(), asked.begin() + 6};
        const auto bytes = static_cast<std::uint8_t>(asked[1] <= 2 ? (asked[5] + 7) / 8 : 2 * asked[5]);
        Bytes answer{asked[0], asked[1], bytes};
        for (std::uint8_t i = 0; i < bytes; ++i)
            answer.push_back(static_cast<std::uint8_t>(questions * 3 + i));
        return answer;
    }
    void hear(std::span<const std::uint8_t> request) {
        asked.assign(request.begin(), request.end());
        asked_at = now;
        taken.clear();
        ++questions;
        Time at = now;
        if (script.rest.empty()) return put(right(), true, at, {});
        for (std::uint8_t what = 0xFF; at < now + 100ms && !script.rest.empty() && what >> 5 != 0;) {
            what = next(1)[0];
            Bytes answer = right();
            const Duration between = (what & 0x10) != 0 ? 700us : 0us;
            switch (what >> 5) {
            case 0: break; // nothing more
            case 1: at += Duration{500us} * (what & 0x1F); break;
            case 2: put(next(1 + (what & 0xFu)), false, at, between); break;
            case 3: put(answer, true, at, between); break;
            case 4: // another content, with a correct checksum
                for (std::size_t place = what & 0xFu;
                     const std::uint8_t by : next((what & 0x10) != 0 ? 2 : 1))
                    answer[place++ % answer.size()] = by;
                put(answer, true, at, between);
                break;
            case 5: // an exception, or an answer of no values
                answer.resize(2);
                answer[1] |= (what & 0x10) != 0 ? 0 : 0x80;
                answer.push_back(what & 0xF);
                put(answer, true, at, {});
                break;
            case 6: // a part, or with a wrong checksum
                seal(answer);
                if ((what & 0xF) != 0) answer.resize(std::min<std::size_t>(answer.size(), what & 0xF));
                answer.back() ^= (what & 0xF) != 0 ? 0 : 1;
                put(answer, false, at, between);
                break;
            default: put(before, false, at, between); // the last one again
            }
        }
        before = right();
        seal(before);
    }
    void put(Bytes bytes, bool sealed, Time& at, Duration between) {
        if (sealed) seal(bytes);
        for (const std::uint8_t each : bytes)
            coming.insert(
                std::ranges::upper_bound(coming, at += between, {}, &std::pair<Time, std::uint8_t>::first),
                {at, each});
    }
    [[nodiscard]] bool has_come() const { return !coming.empty() && coming.front().first <= now; }
    void flush() {
        while (has_come()) coming.pop_front();
    }
    int wait(timeval& left) {
        const Time end = now + Duration{1s} * left.tv_sec + Duration{1us} * left.tv_usec;
        now = coming.empty() ? end : std::clamp(coming.front().first, now, end);
        left = {(end - now) / 1s, (end - now) % 1s / 1us};
        return has_come() ? 1 : 0;
    }
    std::size_t give(std::span<std::uint8_t> into) {
        std::size_t count = 0;
        for (; count < into.size() && has_come(); ++count, coming.pop_front()) {
            if (taken.empty()) first_taken_at = coming.front().first;
            taken.push_back(into[count] = coming.front().second);
        }
        return count;
    }
};
inline Line* line = nullptr;

inline std::string a_terminal() {
    const int end = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (end < 0 || ::grantpt(end) != 0 || ::unlockpt(end) != 0) std::abort();
    const std::string name = ::ptsname(end);
    if (::open(name.c_str(), O_RDWR | O_NOCTTY) < 0) std::abort(); // without a user it would hang up
    return name;
}

} // namespace tappet::fuzz

extern "C" {
int __real_select(int, fd_set*, fd_set*, fd_set*, timeval*);
int __wrap_select(int count, fd_set* in, fd_set* out, fd_set* other, timeval* left) {
    return tappet::fuzz::line != nullptr && count == tappet::fuzz::line->terminal + 1
               ? tappet::fuzz::line->wait(*left)
               : __real_select(count, in, out, other, left);
}
ssize_t __real_read(int, void*, size_t);
ssize_t __wrap_read(int from, void* into, size_t most) {
    if (tappet::fuzz::line == nullptr || from != tappet::fuzz::line->terminal)
        return __real_read(from, into, most);
    return static_cast<ssize_t>(tappet::fuzz::line->give({static_cast<std::uint8_t*>(into), most}));
}
ssize_t __real_write(int, const void*, size_t);
ssize_t __wrap_write(int to, const void* bytes, size_t count) {
    if (tappet::fuzz::line == nullptr || to != tappet::fuzz::line->terminal)
        return __real_write(to, bytes, count);
    tappet::fuzz::line->hear({static_cast<const std::uint8_t*>(bytes), count});
    return static_cast<ssize_t>(count);
}
int __wrap_tcflush(int terminal, int) {
    tappet::fuzz::line->terminal = terminal;
    tappet::fuzz::line->flush();
    return 0;
}
int __real_clock_gettime(clockid_t, timespec*);
int __wrap_clock_gettime(clockid_t clock, timespec* now) {
    if (tappet::fuzz::line == nullptr) return __real_clock_gettime(clock, now);
    *now = {tappet::to_ns(tappet::fuzz::line->now) / 1'000'000'000,
            tappet::to_ns(tappet::fuzz::line->now) % 1'000'000'000};
    return 0;
}
int __wrap_clock_nanosleep(clockid_t, int, const timespec* time, timespec*) {
    tappet::fuzz::line->now += std::chrono::seconds{time->tv_sec} + std::chrono::nanoseconds{time->tv_nsec};
    return 0;
}
}
