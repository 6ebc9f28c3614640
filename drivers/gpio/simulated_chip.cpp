// A chip's outputs, and its faults.
#include "drivers/gpio/simulated_chip.hpp"

namespace tappet::gpio {

std::vector<WireOutput> SimulatedChip::outputs() const {
    std::vector<WireOutput> all;
    for (std::size_t i = 0; i < map_.size(); ++i) {
        const Line& line = map_[i].line;
        if (line.role != Role::output) continue;
        const std::string of{line.name};
        WireOutput output{.name = of, .safe = line.safe_value, .is_switch = true};
        output.read = [this, i](Time) { return std::optional<std::uint64_t>{twin.outputs() >> i & 1}; };
        if (map_[i].driven != Driven::by_port) output.operations = {of + ".set", of + ".clear"};
        all.push_back(std::move(output));
    }
    return all;
}

TwinFault SimulatedChip::strike(Random& random, Time now, bool /*with_any_values*/) {
    Sentence text{"lines \"", name, "\": "};
    const std::uint64_t what = random.below(7);
    std::vector<std::size_t> inputs;
    for (std::size_t i = 0; i < map_.size(); ++i)
        if (map_[i].line.role == Role::input) inputs.push_back(i);
    if (what == 0 || inputs.empty()) {
        twin.set_removed(true);
        return {"chip removed", {text.add("the chip is gone")}, [this](Time) {
                    return twin.set_removed(false), true;
                }};
    }
    if (what == 1) {
        const auto calls = static_cast<std::uint32_t>(random.between(1, 3));
        twin.refuse(calls);
        return {"chip refuses", {text.add("the chip refuses ").add(calls).add(" calls")}, [this](Time) {
                    return twin.refuse(0), true;
                }};
    }
    return strike_line(random, now, what, inputs[random.below(inputs.size())]);
}

TwinFault SimulatedChip::strike_line(Random& random, Time now, std::uint64_t what, std::size_t line) {
    LineFaults& faults = twin.faults(line);
    const auto many = static_cast<std::uint32_t>(random.between(1, 4));
    const auto struck = [&](std::string_view fault, const auto&... words) {
        return TwinFault{fault,
                         {Sentence{"lines \"", name, "\": \"", map_[line].line.name, "\" ", words...}},
                         [&faults](Time) { return faults = {}, true; },
                         false};
    };
    switch (what) {
    case 2: faults.lose_next = many; return struck("line loses edges", "loses ", many, " edges");
    case 3: faults.lose_one_in = many; return struck("line loses edges", "loses one edge in ", many);
    case 4: faults.bounces = many; return struck("line bounces", "bounces ", many, " times");
    case 5:
        faults.delay = Duration{random.between(1'000, 10'000'000)};
        return struck("line is late", "is ", faults.delay / 1us, " us late");
    default: {
        const bool level = random.one_in(2);
        twin.stick(line, level, now);
        TwinFault fault = struck("line sticks", level ? "sticks active" : "sticks inactive");
        fault.end = [this, line](Time at) { return twin.release(line, at), true; };
        return fault;
    }
    }
}

} // namespace tappet::gpio
