// Our reader and decoder agree with canmatrix to the bit, for DBC files and frames of fixed seeds.
#include "apps/carpet_loom/maps.hpp"
#include "drivers/can/dbc/texts.hpp"
#include "drivers/can/dbc/writer.hpp"
#include "drivers/can/signal_store.hpp"
#include "tests/drivers/can/awkward_dbc.hpp"
#include "tests/drivers/can/dbc_generator.hpp"
#include "tests/drivers/can/hex.hpp"
#include "tests/drivers/can/same_map.hpp"
#include "tests/drivers/foreign.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <sstream>

namespace tappet::can {
namespace {

constexpr std::size_t files = 300, awkward_files = 64, frames_of_each = 8;

std::vector<std::string> parts_of(const std::string& text, char between) {
    std::vector<std::string> parts;
    std::istringstream in{text};
    for (std::string part; std::getline(in, part, between);) parts.push_back(part);
    return parts;
}
double from_bits(const std::string& text) { return std::bit_cast<double>(std::stoull(text, nullptr, 16)); }
std::string from_hex(const std::string& hex) {
    std::string text;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        text += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    return text;
}
std::string order_of(const Frame& frame) {
    return std::to_string(frame.id) + (frame.extended ? " 1 " : " 0 ");
}

/// A file with all messages that its node receives; its sent messages are silent when the machine is gone.
struct Taken {
    std::string text, node;
    std::vector<std::string> own{};
    std::vector<FrameRow> rows{};
    std::unique_ptr<DbcMap> read{};

    /// `faults`: selects those of an awkward file; 0: none.
    explicit Taken(std::uint64_t seed, std::uint64_t faults = 0) : node{"us"} {
        DbcGenerator generator{seed};
        text = awkward(generator.file(), faults);
        own = generator.own;
        for (const std::string& each : own) add(each, Direction::transmit, as_in_file);
        read = std::make_unique<DbcMap>(text, NodeView{node, rows, {}});
    }
    /// The text that we wrote for a map.
    template <std::size_t F, std::size_t S>
    explicit Taken(const SignalMap<F, S>& map)
        : text{dbc::to_dbc("the-machine", map.frames, map.signals)}, node{"the_machine"} {
        for (const FrameRow& row : map.frames)
            add(row.name, row.direction, row.every > Duration::zero() ? as_in_file : on_demand(row.apart));
        read = std::make_unique<DbcMap>(text, NodeView{node, rows, {}});
    }

private:
    void add(std::string_view name, Direction direction, const Rate& rate) {
        FrameRow& row = rows.emplace_back();
        row.name = name;
        row.direction = direction;
        row.every = rate.every;
        row.apart = rate.apart;
        row.silence_is_safe = direction == Direction::transmit;
    }
};

/// Multiplexed, written by hand, with names and both kinds of floats.
constexpr ValueName page_names[] = {{0, "läuft"}, {3, "say \"stop\""}};
constexpr auto by_hand =
    signal_map(receive(extended(0x18FF0102), "pages", bytes(8), every(20ms),
                       signal("page", 0, 4).named(page_names), signal("inner", 4, 4).when("page", 3),
                       signal("real", 8, 32).as_float().in("l/min").when("page", 0, between(5, 6)),
                       signal("far", 15, 40)
                           .big_endian()
                           .as_signed()
                           .times(-0.1)
                           .plus(3)
                           .range(-7.5, 9)
                           .when("inner", 1, 4)),
               transmit(standard(2), "double", bytes(8), on_demand(5ms),
                        signal("value", 0, 64).as_float().in("N m").safe(0)));
TAPPET_ACCEPTED(by_hand.fault);
/// Each format, and signals behind the eighth byte.
constexpr auto of_can_fd =
    signal_map(receive(standard(1), "scan", fd_bytes(64), every(20ms), signal("first", 0, 16),
                       signal("across", 61, 64), signal("last", 487, 32).big_endian().as_signed()),
               receive(extended(2), "slow", fd_bytes(12).in_one_rate(), every(20ms), signal("value", 70, 20)),
               transmit(standard(3), "old", bytes(8), every(20ms), signal("value", 0, 64).safe(0)),
               receive(extended(4), "older", bytes(2), every(20ms), signal("value", 0, 16)));
TAPPET_ACCEPTED(of_can_fd.fault);

/// One run of canmatrix over all files and frames; its answers, line by line.
struct Asked {
    std::vector<std::unique_ptr<Taken>> taken;
    std::vector<std::vector<Frame>> frames;
    std::vector<std::string> answers;

    Asked() {
        const std::filesystem::path folder =
            std::filesystem::path{testing::TempDir()} / ("dbc_oracle." + std::to_string(getpid()));
        std::filesystem::create_directories(folder);
        std::ofstream orders{folder / "orders"};
        for (std::size_t i = 0; i < files; ++i) taken.push_back(std::make_unique<Taken>(i + 1));
        taken.push_back(std::make_unique<Taken>(by_hand));
        taken.push_back(std::make_unique<Taken>(carpet::can_signals));
        taken.push_back(std::make_unique<Taken>(of_can_fd));
        for (std::size_t i = 0; i < awkward_files; ++i) taken.push_back(std::make_unique<Taken>(1000 + i, i));
        for (std::size_t i = 0; i < taken.size(); ++i) {
            const std::string path = (folder / (std::to_string(i) + ".dbc")).string();
            std::ofstream{path, std::ios::binary} << taken[i]->text;
            orders << "file " << path << '\n';
            ask(orders, *taken[i], i);
        }
        orders.close();
        std::system(("/usr/bin/python3 -W ignore " TAPPET_DBC_ORACLE " <" + (folder / "orders").string() +
                     " >" + (folder / "answers").string() + " 2>" + (folder / "complaints").string())
                        .c_str());
        std::ifstream in{folder / "answers"};
        for (std::string line; std::getline(in, line);) answers.push_back(line);
        if (answers.empty())
            ADD_FAILURE() << std::ifstream{folder / "complaints"}.rdbuf()
                          << "is python3-canmatrix installed? ci/setup does it";
        std::filesystem::remove_all(folder);
    }

private:
    void ask(std::ostream& orders, const Taken& one, std::size_t seed) {
        Random random{seed};
        auto& mine = frames.emplace_back();
        const auto& map = one.read->map;
        for (std::size_t f = 0; f < one.read->sizes.frames; ++f)
            for (std::size_t n = 0; n < frames_of_each; ++n) {
                Frame frame{.id = map.frames[f].identifier.id,
                            .extended = map.frames[f].identifier.extended,
                            .length = map.frames[f].length};
                set_format(frame, map.frames[f].format);
                for (std::size_t b = 0; b < frame.length; ++b)
                    frame.data[b] = static_cast<std::uint8_t>(random.next());
                mine.push_back(frame);
                orders << "decode " << order_of(frame) << hex_of(frame) << '\n';
                orders << "encode " << order_of(frame);
                for (std::size_t s = map.frames[f].first; s < map.frames[f].end(); ++s)
                    orders << ' ' << map.signals[s].name << '='
                           << raw_text(map.signals[s], extract(frame.data, map.signals[s]));
                orders << '\n';
            }
    }

public:
    static std::string raw_text(const Signal& s, std::uint64_t raw) {
        if (s.kind == Kind::float32)
            return "f" + bits_of(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
        if (s.kind == Kind::float64) return "f" + bits_of(std::bit_cast<double>(raw));
        return s.kind == Kind::signed_integer ? std::to_string(to_integer(s, raw)) : std::to_string(raw);
    }
};

const Asked& asked() {
    static const Asked once;
    return once;
}

/// The differences between our side and canmatrix, after `spoil` changed each map.
class Comparison {
public:
    using Map = SignalMap<64, 512>;
    std::vector<std::string> differences{};
    std::size_t signals = 0, decoded = 0, encoded = 0, fd = 0;

    explicit Comparison(const std::function<void(Map&)>& spoil = [](Map&) {}) {
        std::size_t line = 0;
        const auto next = [&]() -> std::string {
            return line < asked().answers.size() ? asked().answers[line++] : "none";
        };
        for (std::size_t i = 0; i < asked().taken.size(); ++i) {
            const DbcMap& read = *asked().taken[i]->read;
            Map map = read.map;
            spoil(map);
            file_ = i;
            if (!map.fault.empty()) differ("it is refused: ", std::string{map.fault.view()});
            compare_file(map, read.sizes, next);
            for (const Frame& frame : asked().frames[i]) {
                compare_decoded(map, frame, next());
                compare_encoded(map, frame, next());
            }
        }
        if (line != asked().answers.size()) differ("answers are left over", "");
    }

private:
    void differ(const std::string& what, const std::string& said) {
        differences.push_back("seed " + std::to_string(file_ + 1) + ": " + what + said);
    }
    void same(const std::string& who, const std::string& what, const std::string& ours,
              const std::string& theirs) {
        if (ours != theirs) differ(who + ": " + what + ": ", ours + ", canmatrix: " + theirs);
    }

    void compare_file(const Map& map, const dbc::Sizes& sizes, const std::function<std::string()>& next) {
        const std::string& us = asked().taken[file_]->node;
        std::size_t frames = 0, taken = 0;
        std::size_t f = no_such;
        std::string text = next();
        for (; !text.starts_with("end"); text = next()) {
            if (text == "none") return differ("no answer", "");
            auto parts = parts_of(text, '\t');
            parts.resize(14);
            if (parts[0] == "frame") {
                f = parts[4].starts_with("VECTOR__") ? no_such : map.frame(std::string_view{parts[4]});
                if (f == no_such) continue;
                ++frames;
                const FrameRow& row = map.frames[f];
                same(parts[4], "identifier", std::to_string(row.identifier.id), parts[1]);
                same(parts[4], "extended", row.identifier.extended ? "1" : "0", parts[2]);
                same(parts[4], "bytes", std::to_string(row.length), parts[3]);
                fd += row.format != Format::classical;
                same(parts[4], "CAN FD", row.format == Format::classical ? "0" : "1", parts[7]);
                same(parts[4], "bit rate switch", row.format == Format::flexible_faster ? "1" : "0",
                     parts[8]);
                same(parts[4], "cycle time", std::to_string(row.every / 1ms), parts[5]);
                const auto senders = parts_of(parts[6], ',');
                const bool is_ours = std::ranges::find(senders, us) != senders.end();
                same(parts[4], "sent", row.direction == Direction::transmit ? "1" : "0", is_ours ? "1" : "0");
            } else if (f != no_such) {
                const std::size_t s = map.signal(std::string{map.frames[f].name} + "." + parts[1]);
                const auto receivers = parts_of(parts[12], ',');
                const bool named = map.frames[f].direction == Direction::transmit ||
                                   std::ranges::find(receivers, us) != receivers.end();
                if (s == no_such) {
                    if (named) differ(parts[1], " is missing");
                    continue;
                }
                ++taken;
                compare_signal(map.signals[s], parts);
            }
        }
        same("file", "complaints", "", text.substr(4));
        same("file", "messages", std::to_string(sizes.frames), std::to_string(frames));
        same("file", "signals", std::to_string(sizes.signals), std::to_string(taken));
        signals += taken;
    }
    void compare_signal(const Signal& s, const std::vector<std::string>& parts) {
        const std::string& who = parts[1];
        same(who, "first bit", std::to_string(s.start), parts[2]);
        same(who, "bits", std::to_string(s.bits), parts[3]);
        same(who, "order", s.order == Order::intel ? "1" : "0", parts[4]);
        const bool is_float = s.kind == Kind::float32 || s.kind == Kind::float64;
        if (!is_float) same(who, "signed", s.kind == Kind::signed_integer ? "1" : "0", parts[5]);
        same(who, "float", is_float ? "1" : "0", parts[6]);
        same(who, "factor", bits_of(s.factor), parts[7]);
        same(who, "offset", bits_of(s.offset), parts[8]);
        if (s.has_range) {
            same(who, "least", bits_of(s.least), parts[9]);
            same(who, "most", bits_of(s.most), parts[10]);
        }
        std::string unit;
        dbc::put_unit(from_hex(parts[11]), [&](std::string_view piece) { unit += piece; });
        same(who, "unit", std::string{s.unit}, unit);
        std::map<std::string, std::string> theirs;
        for (const std::string& each : parts_of(parts[13], ';'))
            theirs[each.substr(0, each.find('='))] = from_hex(each.substr(each.find('=') + 1));
        same(who, "names", std::to_string(s.names.size()), std::to_string(theirs.size()));
        for (const ValueName& each : s.names)
            same(who, "name of " + std::to_string(each.value), std::string{each.name},
                 theirs[std::to_string(each.value)]);
    }

    void compare_decoded(const Map& map, const Frame& frame, const std::string& answer) {
        SignalStore store{map};
        const std::size_t f = map.frame(Identifier{frame.id, frame.extended});
        std::map<std::string, std::string> theirs;
        for (const std::string& each : parts_of(answer, '\t'))
            if (const std::size_t at = each.find('='); at != each.npos)
                theirs[each.substr(0, at)] = each.substr(at + 1);
        for (std::size_t s = map.frames[f].first; s < map.frames[f].end(); ++s) {
            const Signal& signal = map.signals[s];
            const auto found = theirs.find(std::string{signal.name});
            const std::string who =
                std::string{map.frames[f].name} + "." + std::string{signal.name} + " of " + hex_of(frame);
            const bool holds = store.is_in(map.frames[f], s, frame);
            same(who, "is there", holds ? "1" : "0", found == theirs.end() ? "0" : "1");
            if (!holds || found == theirs.end()) continue;
            ++decoded;
            const auto values = parts_of(found->second, ';');
            const std::uint64_t raw = extract(frame.data, signal);
            const double ours = to_physical(signal, raw), physical = from_bits(values[1]);
            if (std::isnan(ours) && std::isnan(physical)) continue;
            same(who, "raw", Asked::raw_text(signal, raw), values[0]);
            // canmatrix computes with decimals of 28 digits.
            const double size = std::abs((ours - signal.offset)) + std::abs(signal.offset);
            if (ours != physical && !(std::abs(ours - physical) <= 1e-15 * 4 * size))
                differ(who + ": physical: ", bits_of(ours) + ", canmatrix: " + values[1]);
        }
    }
    void compare_encoded(const Map& map, const Frame& frame, const std::string& answer) {
        const std::size_t f = map.frame(Identifier{frame.id, frame.extended});
        SignalStore store{map};
        bool is_plain = true; // a NaN has no text that reads back
        for (std::size_t s = map.frames[f].first; s < map.frames[f].end(); ++s) {
            const std::uint64_t raw = extract(frame.data, asked().taken[file_]->read->map.signals[s]);
            is_plain = is_plain && !std::isnan(to_physical(map.signals[s], raw));
            store.set_bits(s, raw);
        }
        const std::string theirs = parts_of(answer, '\t').back();
        if (theirs == "never" || !is_plain) return;
        ++encoded;
        same(std::string{map.frames[f].name} + " of " + hex_of(frame), "encoded", hex_of(store.encode(f, {})),
             theirs);
    }

    std::size_t file_ = 0;
};

TEST(DbcOracle, agrees_to_the_bit) {
    const Comparison comparison;
    for (std::size_t i = 0; i < comparison.differences.size() && i < 20; ++i)
        ADD_FAILURE() << comparison.differences[i];
    EXPECT_EQ(comparison.differences.size(), 0u);
    EXPECT_GT(comparison.signals, 3000u);
    EXPECT_GT(comparison.decoded, 20000u);
    EXPECT_GT(comparison.encoded, 3000u);
    EXPECT_GT(comparison.fd, 100u);
}

/// Changes the first signal of each map that `is_meant` accepts.
void expect_found(const std::function<bool(const Signal&)>& is_meant,
                  const std::function<void(Signal&)>& change) {
    std::size_t changed = 0;
    const Comparison comparison{[&](SignalMap<64, 512>& map) {
        for (Signal& each : map.signals)
            if (each.bits != 0 && is_meant(each)) {
                change(each);
                ++changed;
                return;
            }
    }};
    EXPECT_GT(changed, 0u);
    EXPECT_GE(2 * comparison.differences.size(), changed) << "not each frame shows each of them";
}

/// The map read back equals the written one, so canmatrix agrees with our writer.
TEST(DbcOracle, reads_written_maps_back_unchanged) {
    expect_same(by_hand, *asked().taken[files]->read, Places::any);
    expect_same(carpet::can_signals, *asked().taken[files + 1]->read, Places::any);
    expect_same(of_can_fd, *asked().taken[files + 2]->read, Places::any);
}

TEST(DbcOracle, detects_a_planted_format) {
    for (const auto& [from, to] : {std::pair{Format::classical, Format::flexible},
                                   {Format::flexible, Format::flexible_faster},
                                   {Format::flexible_faster, Format::classical}}) {
        const Comparison comparison{[&](SignalMap<64, 512>& map) {
            for (FrameRow& each : map.frames)
                if (each.length != 0 && each.format == from) each.format = to;
        }};
        EXPECT_GT(comparison.differences.size(), 20u);
    }
}

TEST(DbcOracle, detects_planted_signal_faults) {
    const auto any = [](const Signal&) { return true; };
    expect_found([](const Signal& s) { return s.start > 0 && s.start % 8 != 0; },
                 [](Signal& s) { --s.start; });
    expect_found([](const Signal& s) { return s.bits > 1 && s.bits % 8 != 0; }, [](Signal& s) { --s.bits; });
    expect_found([](const Signal& s) { return s.kind == Kind::unsigned_integer; },
                 [](Signal& s) { s.kind = Kind::signed_integer; });
    expect_found([](const Signal& s) { return s.kind == Kind::float32; },
                 [](Signal& s) { s.kind = Kind::signed_integer; });
    expect_found([](const Signal& s) { return s.factor != 1; },
                 [](Signal& s) { s.factor = std::nextafter(s.factor, 1e9); });
    expect_found(any, [](Signal& s) { s.offset += 1; });
    expect_found(any, [](Signal& s) { s.unit = "V"; });
    expect_found([](const Signal& s) { return s.has_range; }, [](Signal& s) { s.most += 1; });
    expect_found([](const Signal& s) { return !s.names.empty(); },
                 [](Signal& s) { s.names = s.names.first(1); });
    expect_found([](const Signal& s) { return s.selections.size() == 2; },
                 [](Signal& s) { s.selections.used = 1; });
    expect_found([](const Signal& s) { return !s.selections.empty() && s.selections[0].from > 0; },
                 [](Signal& s) { s.selections[0].from = 0; });
}

} // namespace
} // namespace tappet::can
