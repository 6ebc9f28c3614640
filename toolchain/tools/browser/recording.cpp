// Values as JSON messages, and their types as JSON schemas.
#include "toolchain/tools/browser/recording.hpp"

#include "toolchain/tools/browser/value.hpp"

#include <utility>

namespace tappet::browser {

namespace {

constexpr std::uint16_t lost_id = 1;

std::string of_object(const std::string& properties) {
    return R"({"type": "object", "properties": {)" + properties + "}}";
}

/// Drops older samples; for recording on change keeps the last one, whose value held until then.
void forget_until(std::deque<RecordedSample>& samples, std::int64_t at_ns, bool stands) {
    const std::size_t kept = stands ? 1 : 0;
    while (samples.size() > kept && samples[kept].at_ns < at_ns + static_cast<std::int64_t>(kept))
        samples.pop_front();
}

} // namespace

std::string json_schema(const MapReader& map, std::uint32_t index) {
    const map::Type& type = map.types()[index];
    switch (type.shape) {
    case map::Shape::boolean: return R"({"type": "boolean"})";
    case map::Shape::integer:
    case map::Shape::natural: return R"({"type": "integer"})";
    case map::Shape::duration: return R"({"type": "number", "description": "seconds"})";
    case map::Shape::real: return R"({"type": ["number", "null"]})"; // null: infinite, or not-a-number
    case map::Shape::matrix:
    case map::Shape::sequence: {
        const std::string list = R"({"type": "array", "items": )" + json_schema(map, type.element) + "}";
        const bool of_lists = type.shape == map::Shape::matrix && type.rows != 1 && type.columns != 1;
        return of_lists ? R"({"type": "array", "items": )" + list + "}" : list;
    }
    case map::Shape::record: {
        std::string properties;
        for (std::uint32_t i = 0; i < type.field_count; ++i) {
            const map::Field& field = map.fields()[type.first_field + i];
            properties +=
                (i > 0 ? ", " : "") + in_quotes(map.text(field.name)) + ": " + json_schema(map, field.type);
        }
        return of_object(properties);
    }
    case map::Shape::enumeration: return R"({"type": ["string", "integer"]})"; // a number: it has no name
    case map::Shape::text:
    case map::Shape::opaque:
    case map::Shape::arguments: break;
    }
    return R"({"type": "string"})";
}

Recording::Recording(const MapReader& map, const std::vector<RecordedChannel>& channels, std::int64_t zero_ns)
    : map_{&map}, channels_{&channels}, zero_ns_{zero_ns}, windows_(channels.size()) {
    mcap::put_begin(bytes_, "tappet-browse");
    const map::Header& header = map.header();
    mcap::put_metadata(bytes_, "machine",
                       {{"name", std::string{map.text(header.machine)}},
                        {"board", std::string{map.text(header.board)}},
                        {"build_id", header.build_id.data()},
                        {"clock_zero_ns", std::to_string(zero_ns)}});
    const std::uint16_t lost_schema =
        schema_of("lost", of_object(R"("channel": {"type": "string"}, "samples": {"type": "integer"})"));
    mcap::put_channel(records_, {lost_id, lost_schema, std::string{lost_topic}, "json", {}});
    for (std::uint32_t c = 0; c < channels.size(); ++c) describe(c);
    description_ = records_;
    close_chunk();
}

std::uint16_t Recording::schema_of(const std::string& name, const std::string& json_schema) {
    const auto [found, is_new] =
        schemas_.try_emplace(json_schema, static_cast<std::uint16_t>(schemas_.size() + 1));
    if (is_new) mcap::put_schema(records_, found->second, name, json_schema);
    return found->second;
}

void Recording::describe(std::uint32_t channel) {
    const RecordedChannel& each = (*channels_)[channel];
    const map::Facet& facet = map_->facets()[each.facet];
    const std::uint16_t schema = each.of.is_event != 0
                                     ? schema_of("emissions", of_object(R"("value": {"type": "integer"})"))
                                     : schema_of(type_name(*map_, facet.type),
                                                 of_object("\"value\": " + json_schema(*map_, facet.type)));
    mcap::Pairs about{{"unit", std::string{map_->text(facet.unit)}},
                      {"meaning", std::string{map_->text(facet.doc)}}};
    if (each.of.trigger != recorded::none) {
        about.emplace_back("trigger", (*channels_)[each.of.trigger].name);
        about.emplace_back("before", duration_text(each.of.before_ns));
        about.emplace_back("after", duration_text(each.of.after_ns));
    }
    if (each.of.is_event != 0)
        about.emplace_back("each", "emission");
    else if (each.of.every != 0)
        about.emplace_back("every", std::to_string(each.of.every));
    else
        about.emplace_back("on_change", std::to_string(each.of.band));
    mcap::put_channel(records_, {id_of(channel), schema, each.name, "json", std::move(about)});
}

void Recording::add(std::span<const RecordedSample> samples) {
    for (const RecordedSample& each : samples) {
        if (each.lost != 0) tell_lost(each);
        const recorded::Channel& channel = (*channels_)[each.channel].of;
        if (channel.is_event != 0) open_windows(each);
        if (channel.trigger == recorded::none || each.at_ns <= windows_[each.channel].open_until)
            write(each);
        else
            keep(each);
    }
}

void Recording::open_windows(const RecordedSample& event) {
    for (std::uint32_t c = 0; c < channels_->size(); ++c) {
        const recorded::Channel& channel = (*channels_)[c].of;
        if (channel.trigger != event.channel) continue;
        Window& window = windows_[c];
        window.open_until = event.at_ns + channel.after_ns;
        forget_until(window.before, event.at_ns - channel.before_ns, channel.every == 0);
        for (const RecordedSample& each : window.before) write(each);
        window.before.clear();
    }
}

void Recording::keep(const RecordedSample& sample) {
    const recorded::Channel& channel = (*channels_)[sample.channel].of;
    std::deque<RecordedSample>& before = windows_[sample.channel].before;
    before.push_back(sample);
    forget_until(before, sample.at_ns - channel.before_ns, channel.every == 0);
}

void Recording::end() {
    close_chunk();
    mcap::put_chunk(bytes_, 0, 0, description_); // repeated: without it nothing can be read
    mcap::put_end(bytes_);
}

std::string Recording::take() {
    close_chunk();
    return std::exchange(bytes_, {});
}

void Recording::close_chunk() {
    if (records_.empty()) return;
    mcap::put_chunk(bytes_, first_ns_, last_ns_, records_);
    records_.clear();
    first_ns_ = last_ns_ = 0;
}

void Recording::put(const mcap::Message& message) {
    first_ns_ = first_ns_ == 0 ? message.log_ns : std::min(first_ns_, message.log_ns);
    last_ns_ = std::max(last_ns_, message.log_ns);
    mcap::put_message(records_, message);
    if (records_.size() >= most_in_a_chunk) close_chunk();
}

void Recording::tell_lost(const RecordedSample& sample) {
    lost_ += sample.lost;
    const std::string data = "{\"channel\": " + in_quotes((*channels_)[sample.channel].name) +
                             ", \"samples\": " + std::to_string(sample.lost) + "}";
    put({lost_id, lost_messages_++, static_cast<std::uint64_t>(sample.at_ns + zero_ns_), data});
}

void Recording::write(const RecordedSample& sample) {
    const std::uint32_t type = map_->facets()[(*channels_)[sample.channel].facet].type;
    const std::string value =
        (*channels_)[sample.channel].of.is_event != 0
            ? std::to_string(sample.words[0])
            : to_text(*map_, type, std::as_bytes(std::span{sample.words}), Style::plain);
    const std::string data = "{\"value\": " + value + "}";
    put({id_of(sample.channel), sample.sequence, static_cast<std::uint64_t>(sample.at_ns + zero_ns_), data});
    ++samples_;
}

} // namespace tappet::browser
