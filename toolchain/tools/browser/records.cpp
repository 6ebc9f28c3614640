// Reads tapes from their ends: an overwritten moment ends the reading, and sequence numbers reveal its
// missing samples.
#include "toolchain/tools/browser/records.hpp"

#include <algorithm>
#include <cstring>
#include <tuple>

namespace tappet::browser {

namespace {

constexpr int attempts = 64;

} // namespace

std::expected<RecordReader, std::string> RecordReader::open(const MapReader& map) {
    if (map.header().report_at == 0)
        return std::unexpected("this machine records no values; write a section reporting(report(\"...\")) "
                               "into its table");
    RecordReader reader{map};
    if (const std::string wrong = reader.check(); !wrong.empty())
        return std::unexpected("what the machine records contradicts itself: " + wrong);
    return reader;
}

std::string RecordReader::check() {
    const auto* place = at<recorded::Directory>(0);
    if (place == nullptr) return "it lies outside of the machine's memory";
    recorded::Directory directory;
    std::memcpy(&directory, place, sizeof directory);
    const std::uint64_t room = map_->view().block().size() - map_->header().report_at;
    if (directory.channels > recorded::most_channels ||
        directory.channel_stride < sizeof(recorded::Channel) || directory.tapes > map_->activities().size() ||
        directory.tape_stride < sizeof(recorded::Tape))
        return "it has more than a machine may have";
    for (std::uint32_t t = 0; t < directory.tapes; ++t) {
        const auto* each = at<recorded::Tape>(directory.tapes_at + std::uint64_t{t} * directory.tape_stride);
        const auto* tape = each == nullptr ? nullptr : at<recorded::ValueTape>(each->at);
        if (tape == nullptr) return "a tape lies outside";
        const std::uint64_t words = tape->capacity();
        if ((words & (words - 1)) != 0 || words > room / 8 ||
            recorded::ValueTape::bytes_for(words) > room - each->at || tape->most_words() > words / 2)
            return "a tape is longer than its room";
        tapes_.push_back({tape, tape->head()});
    }
    for (std::uint32_t c = 0; c < directory.channels; ++c) {
        const auto* each =
            at<recorded::Channel>(directory.channels_at + std::uint64_t{c} * directory.channel_stride);
        if (each == nullptr) return "a channel lies outside";
        recorded::Channel channel;
        std::memcpy(&channel, each, sizeof channel);
        if (std::string wrong = add_channel(channel); !wrong.empty()) return wrong;
    }
    next_.resize(channels_.size());
    return {};
}

std::string RecordReader::add_channel(const recorded::Channel& of) {
    if (of.component >= map_->components().size() || of.tape >= tapes_.size())
        return "a channel is of no component";
    const map::Component& component = map_->components()[of.component];
    if (of.facet >= component.facet_count) return "a channel is of no facet";
    const std::uint32_t facet = component.first_facet + of.facet;
    const std::uint32_t type = map_->facets()[facet].type;
    const bool is_event = map_->text(map_->facets()[facet].kind) == "event";
    if (is_event != (of.is_event != 0) ||
        (is_event ? of.bytes != sizeof(std::uint64_t)
                  : type == map::none || map_->types()[type].size != of.bytes))
        return "a channel's values are of another size";
    if (of.trigger != recorded::none && of.trigger >= channels_.size())
        return "a channel's window is around none"; // channels of events stand before it
    if (at<std::uint32_t>(of.next_at) == nullptr) return "a channel is numbered outside";
    channels_.push_back({map_->full_name(facet), facet, of});
    return {};
}

std::optional<RecordedSample> RecordReader::standing(std::uint32_t channel) const {
    const recorded::Channel& of = channels_[channel].of;
    const std::uint32_t activity = map_->components()[of.component].activity;
    RecordedSample sample{.channel = channel,
                          .words = std::vector<std::uint64_t>(recorded::words_of(of.bytes))};
    const bool is_whole = map_->view().consistent(activity, attempts, [&] {
        sample.sequence = *at<std::uint32_t>(of.next_at);
        sample.at_ns = map_->view().word<std::int64_t>(map_->activities()[activity].now_at);
        static_cast<void>( // the map was checked: in range
            map_->view().copy(map_->facets()[channels_[channel].facet].value_at,
                              std::as_writable_bytes(std::span{sample.words}).first(of.bytes)));
    });
    return is_whole ? std::optional{std::move(sample)} : std::nullopt;
}

namespace {

void sort(std::vector<RecordedSample>& samples) {
    std::ranges::sort(samples, {}, [](const RecordedSample& each) {
        return std::tuple{each.at_ns, each.channel, each.sequence};
    });
}

} // namespace

std::vector<RecordedSample> RecordReader::begin() {
    std::vector<RecordedSample> samples;
    for (std::uint32_t c = 0; c < channels_.size(); ++c) {
        auto sample = standing(c);
        if (!sample) continue; // it will be recorded soon
        next_[c] = sample->sequence;
        if (channels_[c].of.every != 0 || channels_[c].of.is_event != 0 || sample->sequence == 0) continue;
        --sample->sequence;
        samples.push_back(std::move(*sample));
    }
    sort(samples);
    return samples;
}

std::vector<RecordedSample> RecordReader::follow() {
    std::vector<RecordedSample> samples;
    for (std::uint32_t t = 0; t < tapes_.size(); ++t)
        if (!follow(tapes_[t], samples)) catch_up(t, samples);
    sort(samples);
    return samples;
}

void RecordReader::catch_up(std::uint32_t tape, std::vector<RecordedSample>& into) {
    for (std::uint32_t c = 0; c < channels_.size(); ++c) {
        const recorded::Channel& of = channels_[c].of;
        if (of.tape != tape || of.every != 0 || of.is_event != 0) continue;
        auto sample = standing(c);
        const std::uint32_t told = next_[c].value_or(0);
        if (!sample || static_cast<std::int32_t>(sample->sequence - told) <= 0) continue;
        sample->lost = next_[c] ? sample->sequence - 1 - told : 0;
        next_[c] = sample->sequence--;
        into.push_back(std::move(*sample));
    }
}

bool RecordReader::follow(Followed& followed, std::vector<RecordedSample>& into) {
    const std::uint64_t head = followed.tape->head();
    bool is_whole = true;
    std::vector<std::pair<recorded::Moment, std::vector<std::uint64_t>>> moments; // the last one first
    recorded::Moment moment;
    for (std::uint64_t after = head; after > followed.position; after = moment.at) {
        is_whole = followed.tape->moment_before(after, moment);
        if (!is_whole) break;
        std::vector<std::uint64_t> words(moment.sample_words());
        is_whole = followed.tape->copy(moment.at, words);
        if (!is_whole) break;
        moments.emplace_back(moment, std::move(words));
    }
    for (auto each = moments.rbegin(); each != moments.rend(); ++each) take(each->first, each->second, into);
    followed.position = head;
    return is_whole;
}

void RecordReader::take(const recorded::Moment& moment, std::span<const std::uint64_t> words,
                        std::vector<RecordedSample>& into) {
    while (!words.empty()) {
        const auto head = recorded::SampleHead::of(words.front());
        words = words.subspan(1);
        if (head.channel >= channels_.size() || head.words > words.size() ||
            head.words != recorded::words_of(channels_[head.channel].of.bytes))
            return; // damaged memory: the numbers reveal the loss
        std::optional<std::uint32_t>& next = next_[head.channel];
        // begin() reported it already.
        const bool is_known = next && static_cast<std::int32_t>(head.sequence - *next) < 0;
        const auto value = words.first(head.words);
        words = words.subspan(head.words);
        if (is_known) continue;
        into.push_back({head.channel,
                        head.sequence,
                        moment.at_ns,
                        next ? head.sequence - *next : 0,
                        {value.begin(), value.end()}});
        next = head.sequence + 1;
    }
}

} // namespace tappet::browser
