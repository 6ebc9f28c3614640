// A machine's recorded cycles (thesis A.2.1), read from its memory: live from the tapes, or the worst ones
// that it kept.
#pragma once

#include "kernel/machine/plan/scope_layout.hpp"
#include "toolchain/tools/browser/map_reader.hpp"

namespace tappet::browser {

/// A function's time in a cycle; the cost of the stamp at its end is subtracted.
struct Block {
    std::uint32_t function = 0;
    std::int64_t begin = 0; ///< ns of the machine's clock
    std::int64_t end = 0;
    [[nodiscard]] std::int64_t took() const { return end - begin; }
};

struct WaveCycle {
    std::uint32_t activity = 0;
    std::int64_t release = 0;
    std::int64_t begin = 0;
    std::int64_t end = 0;
    std::uint32_t left_out = 0; ///< functions that did not fit on the tape
    std::vector<Block> blocks{};
    [[nodiscard]] std::int64_t response() const { return end - release; }
};

struct WaveActivity {
    std::string name{};
    bool real_time = false;
    std::int64_t deadline_ns = 0;          ///< 0: none
    std::vector<std::string> components{}; ///< in the order in which they run

    /// The component whose "step", "timers", "reactions" or "behaviour" the function is.
    [[nodiscard]] std::string component_of(std::uint32_t function) const;
    [[nodiscard]] static std::string_view kind_of(std::uint32_t function);
    [[nodiscard]] std::string name_of(std::uint32_t function) const {
        return component_of(function) + "." + std::string{kind_of(function)};
    }
};

/// Block waves, as the scope of the thesis draws them; the input of all writers of files and texts.
struct Waves {
    std::string machine{};
    std::vector<WaveActivity> activities{};
    std::int64_t stamp_ns = 0;
    std::int64_t from = 0; ///< ns of the machine's clock
    std::int64_t to = 0;
    std::vector<WaveCycle> cycles{}; ///< each activity's in the order of time
};

/// A cycle that the machine kept, and its surroundings.
struct Kept {
    scope::Recording of{};
    std::vector<std::uint64_t> words{};
};

class ScopeReader {
public:
    /// The map must outlive the reader. The error states why there is nothing to read, and the cure.
    static std::expected<ScopeReader, std::string> open(const MapReader& map);

    [[nodiscard]] scope::Directory directory() const;
    /// Returns the kept worst cycles, the last to answer first; nothing when the machine was busy storing
    /// more at each attempt.
    [[nodiscard]] std::optional<std::vector<Kept>> worst() const;
    [[nodiscard]] Waves waves_of(const Kept& kept) const;

    /// Returns a Waves without cycles.
    [[nodiscard]] Waves empty() const;
    [[nodiscard]] const CycleTape& tape(std::uint32_t activity) const;
    /// Adds the cycles after `position` on the activity's tape, and moves `position` behind them. Returns
    /// false when some were overwritten unread.
    bool follow(std::uint32_t activity, std::uint64_t& position, Waves& into) const;
    [[nodiscard]] bool is_ranked(std::uint32_t activity) const { return ranked_[activity]; }

private:
    explicit ScopeReader(const MapReader& map) : map_{&map} {}
    [[nodiscard]] std::string check();
    template <class Record>
    [[nodiscard]] const Record* at(std::uint64_t offset) const {
        return map_->at<Record>(map_->header().scope_at, offset);
    }
    [[nodiscard]] bool copy_worst(std::vector<Kept>& into) const;

    const MapReader* map_;
    scope::Directory places_{}; ///< as checked: its constant part
    std::vector<const CycleTape*> tapes_{};
    std::vector<bool> ranked_{};
};

/// Returns VCD (IEEE 1364-2005, clause 18), for GTKWave: a wire for each activity's cycles and for each
/// function. Time 0 is waves.from.
[[nodiscard]] std::string as_vcd(const Waves& waves);
/// Returns a trace in Chrome's trace event format, for ui.perfetto.dev and chrome://tracing.
[[nodiscard]] std::string as_trace(const Waves& waves);

} // namespace tappet::browser
