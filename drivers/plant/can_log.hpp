// Records a simulated CAN bus as a candump log, and replays such a log, recorded at a machine, in place of a
// bus's nodes.
#pragma once

#include "drivers/can/candump.hpp"
#include "drivers/can/twin_bus.hpp"

#include <cstdint>
#include <deque>
#include <fstream>
#include <map>
#include <string>

namespace tappet {

/// Not real-time; only the plant's thread.
class CanRecorder {
public:
    /// Opens the file, named after `bus` (as in the machine's table), in the folder. The error states the
    /// cure.
    [[nodiscard]] Sentence open(std::string_view bus, const std::string& folder);
    /// Sets the start of the recorded times.
    void begin(Time now) { begun_ = std::min(begun_, now); }
    void record(const can::Frame& frame);
    /// Returns how much was written and how to replay it, or what could not be written. Once, at the end.
    [[nodiscard]] Sentence close(bool& good);

private:
    std::string bus_{}, path_{};
    std::ofstream file_{};
    std::uint64_t frames_ = 0;
    Time begun_ = never, first_{};
};

/// Replays the frames that the machine receives, each at its time since the log's first frame. If the clock
/// of the log is set back, a new stretch begins: its first frame follows the frame before it at once.
/// Compares the frames that the machine sends with those of the log: the n-th of an identifier with the n-th.
/// Not real-time; only the plant's thread.
class CanReplay {
public:
    /// Reads and checks the whole file. The error names file, line and column, and the cure.
    [[nodiscard]] Sentence open(std::string_view bus, const std::string& path, Duration begins_at,
                                std::span<const can::Identifier> received,
                                std::span<const can::Identifier> sent);
    /// Takes a frame that the machine has put on the wire.
    void heard(const can::Frame& frame);
    /// Puts the frames that are due on the bus.
    void play(can::TwinBus& bus, Time now);
    [[nodiscard]] Time next() const noexcept { return next_; }
    [[nodiscard]] bool is_over() const noexcept { return is_over_; }
    /// Returns what stopped the replay before the end: the file has changed. Empty: nothing.
    [[nodiscard]] const Sentence& fault() const noexcept { return fault_; }

    /// Number of frames of the log.
    struct Counts {
        std::uint64_t played = 0, unknown = 0, remote = 0, errors = 0;
        std::uint64_t equal = 0, different = 0; ///< of the machine's own frames
        Time first_different = never;           ///< when the machine sent it
        /// Frames not sent by the machine; and sent frames not in the log, though their identifier is.
        std::uint64_t only_in_log = 0, only_sent = 0;
        bool is_cut = false; ///< its last line is incomplete: the recording was interrupted
        /// How often its clock was set back; the first line after that, and by how much.
        std::uint64_t set_back = 0, set_back_line = 0;
        Duration set_back_by{};
    };
    [[nodiscard]] Counts counts() const;
    /// Returns the counts as text.
    [[nodiscard]] Sentence report() const;

private:
    enum class Kind : std::uint8_t { played, own, unknown, remote, error };
    /// For one identifier: frames of one side that still lack their counterpart.
    struct Waiting {
        bool are_logged = false;
        std::deque<can::Frame> frames{};
    };
    /// Reads a line. Returns false at the end of the file, and on an error: see fault_.
    bool read_line();
    /// Reads the text of the next line that is not empty. False at the end.
    bool read_text();
    /// Adds the time since the line before. False, with fault_, where lines are in disorder.
    bool add_time();
    bool refuse(std::size_t column, std::string_view what, std::string_view more = {},
                std::string_view end = {});
    [[nodiscard]] Kind kind_of(const can::candump::Logged& logged) const;
    void count(Kind kind);
    void meet(const can::Frame& frame, bool is_logged);
    /// Returns whether the last frame read is the machine's own, due now and not sent yet: the frames after
    /// it may be answers to it.
    [[nodiscard]] bool waits_for_machine(Time now) const;

    std::string bus_{}, path_{}, text_{}, interface_{};
    std::ifstream file_{};
    std::size_t line_ = 0;
    std::span<const can::Identifier> received_{}, sent_{};
    std::map<std::uint32_t, Waiting> own_{}; // by identifier: frames of the log that the machine sends
    can::candump::Logged read_{};
    Duration begins_at_{};
    Duration since_first_{}; ///< of the frame that was read
    Time last_{}, begun_ = never, next_ = Time::min();
    bool is_over_ = false;
    std::uint32_t asked_ = 0;
    Time asked_until_ = Time::min();
    Counts counts_{};
    Sentence fault_{};
};

} // namespace tappet
