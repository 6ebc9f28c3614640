// What a machine recorded of its cycles (thesis A.2.1), read out of its memory: live from the tapes, or the
// worst ones that it kept.
#pragma once

#include "kernel/machine/plan/scope_layout.hpp"
#include "toolchain/tools/browser/map_reader.hpp"

namespace tappet::browser {

/// A function's time in a cycle; what taking the stamp at its end costs is subtracted.
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
    std::uint32_t left_out = 0; ///< functions that the tape had no room for
    std::vector<Block> blocks{};
    [[nodiscard]] std::int64_t response() const { return end - release; }
};

struct WaveActivity {
    std::string name{};
    bool real_time = false;
    std::int64_t deadline_ns = 0;          ///< 0: none
    std::vector<std::string> components{}; ///< in the order in which they run

    /// "step", "timers", "reactions" or "behaviour" of a component.
    [[nodiscard]] std::string component_of(std::uint32_t function) const;
    [[nodiscard]] static std::string_view kind_of(std::uint32_t function);
    [[nodiscard]] std::string name_of(std::uint32_t function) const {
        return component_of(function) + "." + std::string{kind_of(function)};
    }
};

/// Block waves, as the scope of the thesis draws them; what the writers of files and texts take.
struct Waves {
    std::string machine{};
    std::vector<WaveActivity> activities{};
    std::int64_t stamp_ns = 0;
    std::int64_t from = 0; ///< ns of the machine's clock
    std::int64_t to = 0;
    std::vector<WaveCycle> cycles{}; ///< of each activity in the order of time
};

/// A cycle that the machine kept, and what ran around it.
struct Kept {
    scope::Recording of{};
    std::vector<std::uint64_t> words{};
};

class ScopeReader {
public:
    /// The map outlives the reader. The error says why there is nothing to read, and the cure.
    static std::expected<ScopeReader, std::string> open(const MapReader& map);

    [[nodiscard]] scope::Directory directory() const;
    /// The worst cycles that are kept, those last to answer first; nothing when the machine was busy keeping
    /// more at each attempt.
    [[nodiscard]] std::optional<std::vector<Kept>> worst() const;
    [[nodiscard]] Waves waves_of(const Kept& kept) const;

    /// Without cycles: what else a Waves holds.
    [[nodiscard]] Waves empty() const;
    [[nodiscard]] const CycleTape& tape(std::uint32_t activity) const;
    /// Adds the cycles that followed `position` on the activity's tape, and moves it after them. False: some
    /// of them were overwritten before they were read.
    bool follow(std::uint32_t activity, std::uint64_t& position, Waves& into) const;
    [[nodiscard]] bool is_ranked(std::uint32_t activity) const { return ranked_[activity]; }

private:
    explicit ScopeReader(const MapReader& map) : map_{&map} {}
    [[nodiscard]] std::string check();
    template <class Record> [[nodiscard]] const Record* at(std::uint64_t offset) const;
    [[nodiscard]] bool copy_worst(std::vector<Kept>& into) const;

    const MapReader* map_;
    scope::Directory places_{}; ///< as it was checked: what never changes of it
    std::vector<const CycleTape*> tapes_{};
    std::vector<bool> ranked_{};
};

/// As VCD (IEEE 1364-2005, clause 18), for GTKWave: a wire for each activity's cycles and for each function.
/// Time 0 is waves.from.
[[nodiscard]] std::string as_vcd(const Waves& waves);
/// As a trace of Chrome's trace event format, for ui.perfetto.dev and chrome://tracing.
[[nodiscard]] std::string as_trace(const Waves& waves);

} // namespace tappet::browser
