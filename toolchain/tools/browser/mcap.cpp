// Records of MCAP: an opcode, a length, and fields in little-endian order; texts and maps have a length of
// four bytes before them.
#include "toolchain/tools/browser/mcap.hpp"

#include "kernel/base/crc.hpp"

#include <algorithm>
#include <set>
#include <span>

namespace tappet::browser::mcap {

namespace {

template <class Number> void put(std::string& into, Number number) {
    for (std::size_t i = 0; i < sizeof number; ++i) into += static_cast<char>(number >> (8 * i) & 0xff);
}
void put_text(std::string& into, std::string_view text) {
    put(into, static_cast<std::uint32_t>(text.size()));
    into += text;
}
void put_pairs(std::string& into, const Pairs& pairs) {
    std::string all;
    for (const auto& [key, value] : pairs) {
        put_text(all, key);
        put_text(all, value);
    }
    put_text(into, all);
}
void put_record(std::string& file, Opcode opcode, std::string_view fields) {
    file += static_cast<char>(opcode);
    put(file, std::uint64_t{fields.size()});
    file += fields;
}

/// Reads fields from the front of a record; a missing field marks it broken.
class Fields {
public:
    explicit Fields(std::string_view left) : left_{left} {}

    template <class Number> Number number() {
        const std::string_view bytes = take(sizeof(Number));
        Number value = 0;
        for (std::size_t i = 0; i < bytes.size(); ++i)
            value = static_cast<Number>(value | Number{static_cast<unsigned char>(bytes[i])} << (8 * i));
        return value;
    }
    std::string_view text() { return take(number<std::uint32_t>()); }
    Pairs pairs() {
        Fields all{text()};
        Pairs found;
        while (!all.left_.empty() && !all.broken_) {
            const std::string key{all.text()};
            found.emplace_back(key, all.text());
        }
        broken_ |= all.broken_;
        return found;
    }
    [[nodiscard]] std::string_view rest() const { return left_; }
    [[nodiscard]] bool is_broken() const { return broken_; }

private:
    std::string_view take(std::size_t bytes) {
        if (bytes > left_.size()) {
            broken_ = true;
            left_ = {};
            return {};
        }
        const std::string_view taken = left_.substr(0, bytes);
        left_.remove_prefix(bytes);
        return taken;
    }

    std::string_view left_;
    bool broken_ = false;
};

/// Reads one record's fields into `into`; returns false when they contradict their length.
bool take_record(Opcode opcode, std::string_view bytes, Contents& into) {
    Fields fields{bytes};
    switch (opcode) {
    case Opcode::schema: {
        const auto id = fields.number<std::uint16_t>();
        static_cast<void>(fields.text()); // its name
        static_cast<void>(fields.text()); // its encoding
        into.schemas[id] = fields.text();
        break;
    }
    case Opcode::channel: {
        Channel channel;
        channel.id = fields.number<std::uint16_t>();
        channel.schema = fields.number<std::uint16_t>();
        channel.topic = fields.text();
        channel.encoding = fields.text();
        channel.metadata = fields.pairs();
        if (std::ranges::find(into.channels, channel.id, &Channel::id) == into.channels.end())
            into.channels.push_back(std::move(channel));
        break;
    }
    case Opcode::message: {
        Message message;
        message.channel = fields.number<std::uint16_t>();
        message.sequence = fields.number<std::uint32_t>();
        message.log_ns = fields.number<std::uint64_t>();
        static_cast<void>(fields.number<std::uint64_t>()); // the publish time
        message.data = fields.rest();
        into.messages.push_back(message);
        break;
    }
    case Opcode::metadata: {
        const std::string name{fields.text()};
        into.metadata[name] = fields.pairs();
        break;
    }
    case Opcode::footer: into.has_end = true; break;
    case Opcode::header:
    case Opcode::chunk:
    case Opcode::data_end: break;
    }
    return !fields.is_broken();
}

constexpr std::size_t head_bytes = 9;
/// Returns true for an opcode in neither range of the specification: its own and the private one.
bool is_of_no_kind(char opcode) {
    const auto kind = static_cast<unsigned char>(opcode);
    return kind > 0x0F && kind < 0x80;
}

std::uint32_t checksum(std::string_view bytes) {
    return crc32({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

void tell_damage(Contents& into, const std::string& what, std::size_t at) {
    if (into.damage.empty()) into.damage = what + " at byte " + std::to_string(at);
}

std::expected<void, std::string> take_records(std::string_view bytes, std::size_t begin, bool in_chunk,
                                              Contents& into);

/// The error is that of take_records().
std::expected<void, std::string> take_chunk(std::string_view fields, std::size_t at, Contents& into) {
    Fields chunk{fields};
    const auto first_ns = chunk.number<std::uint64_t>(), last_ns = chunk.number<std::uint64_t>();
    const auto unpacked = chunk.number<std::uint64_t>();
    const auto sum = chunk.number<std::uint32_t>();
    const bool is_packed = !chunk.text().empty();
    const auto size = chunk.number<std::uint64_t>();
    const std::string_view records = chunk.rest();
    const bool is_whole = !chunk.is_broken() && size == records.size() &&
                          (is_packed || (unpacked == size && (sum == 0 || sum == checksum(records))));
    if (!is_whole) {
        tell_damage(into, "a chunk does not have its checksum", at);
        return {};
    }
    if (is_packed)
        return std::unexpected(std::string{
            "has compressed chunks, which tappet-browse cannot read; write it without compression"});
    const auto before = static_cast<std::ptrdiff_t>(into.messages.size());
    const auto taken = take_records(records, at + head_bytes + fields.size() - size, true, into);
    const std::span messages{into.messages.begin() + before, into.messages.end()};
    const auto [first, last] = std::ranges::minmax_element(messages, {}, &Message::log_ns);
    if (!messages.empty() && (first->log_ns != first_ns || last->log_ns != last_ns))
        tell_damage(into, "a chunk states other times than its messages", at);
    return taken;
}

/// Reads the records of a file, or of a chunk, from byte `begin`. The error names what cannot be read here.
std::expected<void, std::string> take_records(std::string_view bytes, std::size_t begin, bool in_chunk,
                                              Contents& into) {
    std::string_view left = bytes;
    for (std::size_t at = begin; !into.has_end && left.size() >= head_bytes;) {
        const auto opcode = static_cast<Opcode>(left[0]);
        const auto length = Fields{left.substr(1)}.number<std::uint64_t>();
        if (left[0] == 0 || length > left.size() - head_bytes) break;
        const std::string_view fields = left.substr(head_bytes, length);
        if (opcode == Opcode::chunk && !in_chunk) {
            if (auto taken = take_chunk(fields, at, into); !taken) return taken;
        } else if (in_chunk && opcode != Opcode::schema && opcode != Opcode::channel &&
                   opcode != Opcode::message) {
            tell_damage(into, "a chunk holds what belongs into none", at);
        } else if (is_of_no_kind(left[0]) || !take_record(opcode, fields, into)) {
            tell_damage(into, "a record is of no kind, or contradicts itself", at);
        }
        left.remove_prefix(head_bytes + length);
        at += head_bytes + length;
        into.whole_bytes = std::max(into.whole_bytes, at);
    }
    const bool is_cut = into.has_end ? !left.empty() && left != magic
                                     : left.ends_with(magic) || (!left.empty() && left[0] == 0 &&
                                                                 left.find_first_not_of('\0') != left.npos);
    if (is_cut) tell_damage(into, "there is no record", begin + bytes.size() - left.size());
    return {};
}

} // namespace

void put_begin(std::string& file, std::string_view library) {
    file += magic;
    std::string fields;
    put_text(fields, ""); // no profile
    put_text(fields, library);
    put_record(file, Opcode::header, fields);
}

void put_schema(std::string& file, std::uint16_t id, std::string_view name, std::string_view json_schema) {
    std::string fields;
    put(fields, id);
    put_text(fields, name);
    put_text(fields, "jsonschema");
    put_text(fields, json_schema);
    put_record(file, Opcode::schema, fields);
}

void put_channel(std::string& file, const Channel& channel) {
    std::string fields;
    put(fields, channel.id);
    put(fields, channel.schema);
    put_text(fields, channel.topic);
    put_text(fields, channel.encoding);
    put_pairs(fields, channel.metadata);
    put_record(file, Opcode::channel, fields);
}

void put_message(std::string& file, const Message& message) {
    std::string fields;
    put(fields, message.channel);
    put(fields, message.sequence);
    put(fields, message.log_ns);
    put(fields, message.log_ns);
    fields += message.data;
    put_record(file, Opcode::message, fields);
}

void put_chunk(std::string& file, std::uint64_t first_ns, std::uint64_t last_ns, std::string_view records) {
    std::string fields;
    put(fields, first_ns);
    put(fields, last_ns);
    put(fields, std::uint64_t{records.size()});
    put(fields, checksum(records));
    put_text(fields, ""); // not compressed
    put(fields, std::uint64_t{records.size()});
    fields += records;
    put_record(file, Opcode::chunk, fields);
}

void put_metadata(std::string& file, std::string_view name, const Pairs& values) {
    std::string fields;
    put_text(fields, name);
    put_pairs(fields, values);
    put_record(file, Opcode::metadata, fields);
}

void put_end(std::string& file) {
    std::string fields;
    put(fields, std::uint32_t{0}); // no checksum
    put_record(file, Opcode::data_end, fields);
    fields.clear();
    put(fields, std::uint64_t{0}); // no summary
    put(fields, std::uint64_t{0});
    put(fields, std::uint32_t{0});
    put_record(file, Opcode::footer, fields);
    file += magic;
}

std::expected<Contents, std::string> read(std::string_view file) {
    if (!file.starts_with(magic.substr(0, file.size())))
        return std::unexpected(std::string{"is not an MCAP file; 'report start' writes one"});
    Contents contents;
    if (file.size() < magic.size()) return contents;
    contents.whole_bytes = magic.size();
    if (auto taken = take_records(file.substr(magic.size()), magic.size(), false, contents); !taken)
        return std::unexpected(taken.error());
    contents.has_end = contents.has_end && file.ends_with(magic);
    std::set<std::uint16_t> known;
    for (const Channel& each : contents.channels) known.insert(each.id);
    std::erase_if(contents.messages, [&](const Message& each) {
        const bool is_known = known.contains(each.channel);
        if (!is_known)
            tell_damage(contents,
                        "a message is of channel " + std::to_string(each.channel) + ", which is not there,",
                        static_cast<std::size_t>(each.data.data() - file.data()));
        return !is_known;
    });
    return contents;
}

} // namespace tappet::browser::mcap
