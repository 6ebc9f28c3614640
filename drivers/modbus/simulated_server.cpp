// A server's outputs, which are the registers that the machine writes, and its faults.
#include "drivers/modbus/simulated_server.hpp"

#include "drivers/modbus/session.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace tappet::modbus {

namespace {

WireNumbers numbers_of(const Register& one) {
    constexpr double largest_float = std::numeric_limits<float>::max();
    const double wide = one.width() == 2 ? 4294967296.0 : 65536.0;
    const auto between = [&one](double low, double high) {
        return WireNumbers::between(low * one.factor + one.offset, high * one.factor + one.offset,
                                    std::abs(one.factor));
    };
    switch (one.kind) {
    case Kind::bit: return between(0, 1);
    case Kind::unsigned_word:
    case Kind::unsigned_double: return between(0, wide - 1);
    case Kind::signed_word:
    case Kind::signed_double: return between(-wide / 2, wide / 2 - 1);
    case Kind::float_double: break;
    }
    return between(-largest_float, largest_float);
}

double physical_of(const Register& one, std::uint64_t all) {
    const auto low = static_cast<std::uint16_t>(all);
    return to_physical(one,
                       one.width() == 2 ? Words{static_cast<std::uint16_t>(all >> 16), low} : Words{low, 0});
}

} // namespace

std::vector<WireOutput> SimulatedServer::outputs() const {
    std::vector<WireOutput> outputs;
    for (const Row& request : safe_->rows) {
        if (!request.write) continue;
        for (const Register& one : safe_->registers.subspan(request.first, request.values)) {
            const auto whole = [width = one.width()](auto word) {
                std::uint64_t all = 0;
                for (unsigned w = 0; w < width; ++w) all = all << 16 | word(w);
                return all;
            };
            WireOutput output{.name = std::string{request.name} + "." + std::string{one.name},
                              .is_switch = one.kind == Kind::bit,
                              .settles = request.every,
                              .recovers = Backoff{}.most,
                              .goes_in = request.first,
                              .numbers = numbers_of(one)};
            output.physical = [&one](std::uint64_t all) { return physical_of(one, all); };
            if (one.says_safe)
                output.safe =
                    whole([words = to_words(one, one.safe_value)](unsigned w) { return words.words[w]; });
            output.read = [this, whole, table = request.run.table, at = request.run.address + one.at](Time) {
                return std::optional<std::uint64_t>{
                    whole([&](unsigned w) { return twin.get(table, at + w); })};
            };
            outputs.push_back(std::move(output));
        }
    }
    return outputs;
}

TwinFault SimulatedServer::strike(Random& random, Time, bool with_any_values) {
    if (with_any_values && random.one_in(3)) return say_anything(random);
    constexpr std::array<std::string_view, 6> names{
        "is silent", "is slow", "answers exceptions", "answers wrong ones", "answers garbage", "is down"};
    const std::size_t what = random.below(names.size());
    const auto requests = static_cast<std::uint32_t>(random.between(1, 20));
    twin.set_slow_by(Duration{random.between(1'000'000, 1'000'000'000)});
    twin.inject(static_cast<Fault>(what + 1), requests);
    return {"server faults",
            {Sentence{"server \"", name, "\" ", names[what], " ", requests, " times"}},
            [this](Time) { return twin.inject(Fault::none), true; }};
}

/// Garbles the registers that the machine reads, until the plant writes them again.
TwinFault SimulatedServer::say_anything(Random& random) {
    TwinFault struck{.kind = "server says anything"};
    for (const Row& row : safe_->rows) {
        if (row.write) continue;
        const bool is_bit = holds_bits(row.run.table);
        const std::uint16_t word = static_cast<std::uint16_t>(is_bit             ? random.below(2)
                                                              : random.one_in(2) ? 0x7FFF + random.below(3)
                                                                                 : random.below(65536));
        for (std::size_t i = 0; i < row.run.count; ++i) twin.set(row.run.table, row.run.address + i, word);
        struck.texts.push_back(
            Sentence{"server \"", name, "\" says ", std::uint64_t{word}, " in ", row.name});
    }
    return struck;
}

} // namespace tappet::modbus
