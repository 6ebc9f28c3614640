// Carries frames, levels and registers between the twins and the plant, step by step of virtual time.
#include "apps/carpet_loom/host/in_process_loom.hpp"

namespace tappet::carpet {

namespace {

/// The plant's own offsets: the twin has no board.
int offset_of(std::string_view name) {
    namespace line = loom::wires::line;
    constexpr std::pair<std::string_view, unsigned> offsets[] = {
        {"emergency_stop", line::emergency_stop},
        {"drop_wire", line::drop_wire},
        {"weft_detector", line::weft_detector},
        {"button_start", line::button_start},
        {"button_stop", line::button_stop},
        {"button_acknowledge", line::button_acknowledge},
        {"weft_release", line::weft_release},
        {"brake", line::brake},
        {"lamp_run", line::lamp_run},
        {"lamp_stop", line::lamp_stop},
        {"lamp_fault", line::lamp_fault},
        {"yarn_cutter", line::yarn_cutter},
    };
    for (const auto& [each, offset] : offsets)
        if (each == name) return static_cast<int>(offset);
    return -1;
}

} // namespace

InProcessLoom::InProcessLoom(const loom::Settings& settings, std::uint64_t seed)
    : plant_{settings, seed}, bus_{seed}, lines_{seed} {}

std::expected<void, Sentence> InProcessLoom::open() {
    can::Settings can_settings;
    can_settings.interface = "twin";
    can_settings.receive = std::span{can_signals.received}.first(can_signals.received_count);
    can_settings.transmit = std::span{can_signals.transmitted}.first(can_signals.transmitted_count);
    if (auto opened = machine_can_.open(can_settings); !opened) return opened;
    std::swap(can_settings.receive, can_settings.transmit);
    if (auto opened = plant_can_.open(can_settings); !opened) return opened;
    if (!bus_.attach(machine_can_) || !bus_.attach(plant_can_))
        return std::unexpected(Sentence{"twin bus: no room for two ends"});
    const auto lines = gpio::placed(io_lines, offset_of);
    if (!lines) return std::unexpected(lines.error());
    line_settings_ = *lines;
    if (auto opened = lines_.open({"twin", line_settings_}); !opened) return opened;
    provided_ = {{{type_id<can::Device>, "loom-can", static_cast<can::Device*>(&machine_can_)},
                  {type_id<gpio::Device>, "loom-io", static_cast<gpio::Device*>(&lines_)},
                  {type_id<modbus::Transport>, "loom-utility", static_cast<modbus::Transport*>(&utility_)}}};
    return {};
}

void InProcessLoom::advance(Time now) {
    lines_to_plant(now);
    bus_.deliver_until(now);
    frames_to_plant(now);
    plant_.advance(now - origin_);
    frames_to_machine(now);
    bus_.deliver_until(now);
    lines_to_machine(now);
    registers();
}

void InProcessLoom::frames_to_plant(Time now) {
    can::Frame frame;
    while (true) {
        const can::Receive got = plant_can_.receive(frame);
        if (got.what == can::Received::none) return;
        if (got.what == can::Received::frame)
            plant_.receive({frame.id, frame.length, frame.data}, now - origin_);
    }
}

void InProcessLoom::frames_to_machine(Time now) {
    const auto send = [this, now](const loom::CanFrame& frame) {
        can::Frame out;
        out.id = frame.id;
        out.length = frame.length;
        out.data = frame.data;
        out.stamp = now;
        static_cast<void>(plant_can_.send(out, can::Keep::every));
    };
    loom::CanFrame frame;
    loom::CanFrame sample;
    bool is_sampled = false;
    Time due;
    while (plant_.transmit(frame, due)) {
        if (frame.id != loom::wires::cob::encoder_position) {
            send(frame);
            continue;
        }
        sample = frame;
        is_sampled = true;
    }
    if (is_sampled) { // who comes late sends the shaft as it is, once, not as it was
        const std::uint16_t code = plant_.encoder_code();
        sample.data[0] = static_cast<std::uint8_t>(code & 0xFFu);
        sample.data[1] = static_cast<std::uint8_t>(code >> 8);
        send(sample);
    }
    plant_can_.service(now);
}

void InProcessLoom::lines_to_plant(Time now) {
    const gpio::Mask outputs = lines_.outputs();
    if (outputs == seen_outputs_) return;
    for (std::size_t i = 0; i < line_settings_.size(); ++i)
        if (line_settings_[i].role == gpio::Role::output && ((outputs ^ seen_outputs_) >> i & 1u) != 0)
            plant_.set_line(line_settings_[i].offset, (outputs >> i & 1u) != 0, now - origin_);
    seen_outputs_ = outputs;
}

void InProcessLoom::lines_to_machine(Time now) {
    loom::Edge edge;
    while (plant_.next_edge(edge))
        for (std::size_t i = 0; i < line_settings_.size(); ++i)
            if (line_settings_[i].offset == edge.line)
                static_cast<void>(lines_.drive(i, edge.level, edge.at + origin_));
    lines_.deliver_until(now);
}

void InProcessLoom::registers() {
    namespace at = loom::wires::modbus;
    auto& climate = plant_.climate();
    for (std::uint16_t i = 0; i < at::input_register::count; ++i)
        if (const auto value = climate.input_register(i))
            utility_.set(modbus::Table::input_registers, i, *value);
    static_cast<void>(climate.write_coil(
        at::coil::lubrication_pump, utility_.get(modbus::Table::coils, at::coil::lubrication_pump) != 0));
}

} // namespace tappet::carpet
