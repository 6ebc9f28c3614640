// What is on a simulated CAN bus as a candump log; and such a log, as it was recorded at a machine, in place
// of the nodes of a bus.
#pragma once

#include "drivers/can/candump.hpp"
#include "drivers/can/twin_bus.hpp"

#include <cstdint>
#include <deque>
#include <fstream>
#include <map>
#include <string>

namespace tappet {

/// Not real-time; one thread, the plant's.
class CanRecorder {
public:
    /// `bus` as the machine's table names it: the file is that name's in the folder. The error says what to
    /// do.
    [[nodiscard]] Sentence open(std::string_view bus, const std::string& folder);
    /// Times are written from here on.
    void begin(Time now) { begun_ = std::min(begun_, now); }
    void record(const can::Frame& frame);
    /// How much was written, and how it is replayed; or what could not be written. Once, at the end.
    [[nodiscard]] Sentence close(bool& good);

private:
    std::string bus_{}, path_{};
    std::ofstream file_{};
    std::uint64_t frames_ = 0;
    Time begun_ = never, first_{};
};

/// Plays the frames that the machine receives, each at its time since the log's first frame. Those that the
/// machine sends itself are compared with what it sends, the n-th of an identifier with its n-th. Not
/// real-time; one thread, the plant's.
class CanReplay {
public:
    /// Reads all of the file. The error names file, line and column, and the cure.
    [[nodiscard]] Sentence open(std::string_view bus, const std::string& path, Duration begins_at,
                                std::span<const can::Identifier> received,
                                std::span<const can::Identifier> sent);
    /// What the machine has put on the wire.
    void heard(const can::Frame& frame);
    /// Puts on the bus what is due.
    void play(can::TwinBus& bus, Time now);
    [[nodiscard]] Time next() const noexcept { return next_; }
    [[nodiscard]] bool is_over() const noexcept { return is_over_; }
    /// What stopped it before the end: the file is another one than it was. Empty: nothing did.
    [[nodiscard]] const Sentence& fault() const noexcept { return fault_; }

    /// Frames of the log.
    struct Counts {
        std::uint64_t played = 0, unknown = 0, remote = 0, errors = 0;
        std::uint64_t equal = 0, different = 0; ///< of the machine's own
        Time first_different = never;           ///< when the machine sent it
        /// The machine has not sent them; nor does the log have these of the identifiers that it has.
        std::uint64_t only_in_log = 0, only_sent = 0;
        bool is_cut = false; ///< its last line has no end: whoever wrote it was ended there
    };
    [[nodiscard]] Counts counts() const;
    /// The counts, for people.
    [[nodiscard]] Sentence report() const;

private:
    enum class Kind : std::uint8_t { played, own, unknown, remote, error };
    /// Of one identifier: frames that one side has and the other not yet.
    struct Waiting {
        bool are_logged = false;
        std::deque<can::Frame> frames{};
    };
    /// False at the end of the file, and when it is bad: see fault_.
    bool read_line();
    [[nodiscard]] Kind kind_of(const can::candump::Logged& logged) const;
    void count(Kind kind);
    void meet(const can::Frame& frame, bool is_logged);
    /// The frame that was read last is the machine's own, of this very moment, and not sent yet: what came
    /// after it may be the answer.
    [[nodiscard]] bool waits_for_machine(Time now) const;

    std::string bus_{}, path_{}, text_{}, interface_{};
    std::ifstream file_{};
    std::size_t line_ = 0;
    std::span<const can::Identifier> received_{}, sent_{};
    std::map<std::uint32_t, Waiting> own_{}; // of each identifier of the log that the machine sends
    can::candump::Logged read_{};
    Duration begins_at_{};
    Time first_{}, last_{}, begun_ = never, next_ = Time::min();
    bool is_over_ = false;
    std::uint32_t asked_ = 0;
    Time asked_until_ = Time::min();
    Counts counts_{};
    Sentence fault_{};
};

} // namespace tappet
