// Converts recorded values to the records of a self-describing file.
#pragma once

#include "toolchain/tools/browser/mcap.hpp"
#include "toolchain/tools/browser/records.hpp"

#include <deque>
#include <limits>
#include <utility>

namespace tappet::browser {

/// The topic of lost samples: {"channel": NAME, "samples": N}.
inline constexpr std::string_view lost_topic = "lost";

/// The recording of one file. A sample becomes a message {"value": VALUE}, preceded by its JSON schema. A
/// channel with a window records only samples around its event; those from before the event stand behind it.
class Recording {
public:
    /// `zero_ns`: offset from the machine's clock to the time since 1970.
    Recording(const MapReader& map, const std::vector<RecordedChannel>& channels, std::int64_t zero_ns);

    /// Adds samples in the order of time.
    void add(std::span<const RecordedSample> samples);
    /// Ends the recording: nothing follows.
    void end();
    /// Returns the bytes since the last call.
    [[nodiscard]] std::string take();

    [[nodiscard]] std::uint64_t samples() const { return samples_; }
    [[nodiscard]] std::uint64_t lost() const { return lost_; }

private:
    struct Window {
        std::deque<RecordedSample> before{}; ///< not written; of the time before a possible event
        std::int64_t open_until = std::numeric_limits<std::int64_t>::min();
    };

    void open_windows(const RecordedSample& event);
    void keep(const RecordedSample& sample);
    void describe(std::uint32_t channel);
    [[nodiscard]] std::uint16_t schema_of(const std::string& name, const std::string& json_schema);
    [[nodiscard]] std::uint16_t id_of(std::uint32_t channel) const {
        return static_cast<std::uint16_t>(channel + 2); // the first one holds the losses
    }
    void tell_lost(const RecordedSample& sample);
    void write(const RecordedSample& sample);
    void put(const mcap::Message& message);
    void close_chunk();
    static constexpr std::size_t most_in_a_chunk =
        8192; ///< bytes; one damaged byte makes a reader lose this many

    const MapReader* map_;
    const std::vector<RecordedChannel>* channels_;
    std::int64_t zero_ns_;
    std::vector<Window> windows_{}; ///< of each channel
    std::map<std::string, std::uint16_t> schemas_{};
    std::string description_{};                ///< of the channels
    std::string bytes_{}, records_{};          ///< complete ones; of the chunk that is being filled
    std::uint64_t first_ns_ = 0, last_ns_ = 0; ///< of the messages in it
    std::uint64_t samples_ = 0;
    std::uint64_t lost_ = 0;
    std::uint32_t lost_messages_ = 0;
};

/// Returns a value's type as a JSON schema.
[[nodiscard]] std::string json_schema(const MapReader& map, std::uint32_t type);

} // namespace tappet::browser
