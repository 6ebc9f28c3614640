// Values that a machine records (thesis 3.3, Reporting), read off the tapes in its memory while it runs.
#pragma once

#include "kernel/services/reporting/layout.hpp"
#include "toolchain/tools/browser/map_reader.hpp"

#include <optional>

namespace tappet::browser {

struct RecordedChannel {
    std::string name{};
    std::uint32_t facet = 0; ///< of the map
    recorded::Channel of{};
};

struct RecordedSample {
    std::uint32_t channel = 0;
    std::uint32_t sequence = 0;
    std::int64_t at_ns = 0;             ///< the machine's clock, of the cycle
    std::uint32_t lost = 0;             ///< so many of the channel before it were overwritten unseen
    std::vector<std::uint64_t> words{}; ///< of the value
};

/// Follows the tapes from where they stand now. Nothing in the memory is believed before it was checked.
class RecordReader {
public:
    /// The map outlives the reader. The error says why there is nothing to read, and the cure.
    static std::expected<RecordReader, std::string> open(const MapReader& map);

    [[nodiscard]] const std::vector<RecordedChannel>& channels() const { return channels_; }
    /// Called once, before follow(): the values that stand, of what is recorded on change, and else would be
    /// unknown until then.
    [[nodiscard]] std::vector<RecordedSample> begin();
    /// What was recorded since the last call, in the order of time.
    [[nodiscard]] std::vector<RecordedSample> follow();

private:
    struct Followed {
        const recorded::ValueTape* tape = nullptr;
        std::uint64_t position = 0;
    };

    explicit RecordReader(const MapReader& map) : map_{&map} {}
    [[nodiscard]] std::string check();
    [[nodiscard]] std::string add_channel(const recorded::Channel& channel);
    template <class Record> [[nodiscard]] const Record* at(std::uint64_t offset) const;
    /// What stands in the channel, with the number of its next sample; nothing: its activity runs all the
    /// time.
    [[nodiscard]] std::optional<RecordedSample> standing(std::uint32_t channel) const;
    /// False: some of it was overwritten.
    [[nodiscard]] bool follow(Followed& followed, std::vector<RecordedSample>& into);
    /// Of what is recorded on change nothing more may come: what stands, where it is not what was told last.
    void catch_up(std::uint32_t tape, std::vector<RecordedSample>& into);
    void take(const recorded::Moment& moment, std::span<const std::uint64_t> words,
              std::vector<RecordedSample>& into);

    const MapReader* map_;
    std::vector<RecordedChannel> channels_{};
    std::vector<Followed> tapes_{};
    std::vector<std::optional<std::uint32_t>> next_{}; ///< of each channel, the number of its next sample
};

} // namespace tappet::browser
