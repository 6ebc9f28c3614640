// Values that a machine records (thesis 3.3, Reporting), read from the tapes in its memory while it runs.
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
    std::uint32_t lost = 0;             ///< samples of the channel before it that were overwritten unread
    std::vector<std::uint64_t> words{}; ///< of the value
};

/// Follows the tapes from their present position. Validates everything in the memory before use.
class RecordReader {
public:
    /// The map must outlive the reader. The error states why there is nothing to read, and the cure.
    static std::expected<RecordReader, std::string> open(const MapReader& map);

    [[nodiscard]] const std::vector<RecordedChannel>& channels() const { return channels_; }
    /// Call once, before follow(): returns the present values of channels recorded on change, which would
    /// otherwise be unknown until their next change.
    [[nodiscard]] std::vector<RecordedSample> begin();
    /// Returns the samples since the last call, in the order of time.
    [[nodiscard]] std::vector<RecordedSample> follow();

private:
    struct Followed {
        const recorded::ValueTape* tape = nullptr;
        std::uint64_t position = 0;
    };

    explicit RecordReader(const MapReader& map) : map_{&map} {}
    [[nodiscard]] std::string check();
    [[nodiscard]] std::string add_channel(const recorded::Channel& channel);
    template <class Record>
    [[nodiscard]] const Record* at(std::uint64_t offset) const {
        return map_->at<Record>(map_->header().report_at, offset);
    }
    /// Returns the channel's present value, with the number of its next sample; nothing: its activity is
    /// always busy.
    [[nodiscard]] std::optional<RecordedSample> standing(std::uint32_t channel) const;
    /// Returns false when some of it was overwritten.
    [[nodiscard]] bool follow(Followed& followed, std::vector<RecordedSample>& into);
    /// A channel on change may get no further sample: adds its present value, unless reported last.
    void catch_up(std::uint32_t tape, std::vector<RecordedSample>& into);
    void take(const recorded::Moment& moment, std::span<const std::uint64_t> words,
              std::vector<RecordedSample>& into);

    const MapReader* map_;
    std::vector<RecordedChannel> channels_{};
    std::vector<Followed> tapes_{};
    std::vector<std::optional<std::uint32_t>> next_{}; ///< number of each channel's next sample
};

} // namespace tappet::browser
