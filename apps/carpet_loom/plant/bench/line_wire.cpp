// Lines between the plant and gpio-sim.
#include "apps/carpet_loom/plant/bench/line_wire.hpp"

#include <cerrno>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <unistd.h>

namespace tappet::loom {

LineWire::LineWire() {
    pulls_.fill(-1);
    values_.fill(-1);
}

LineWire::LineWire(LineWire&& other) noexcept
    : pulls_(other.pulls_),
      values_(other.values_),
      levels_(other.levels_),
      slow_at_(other.slow_at_),
      failures_(other.failures_) {
    other.pulls_.fill(-1);
    other.values_.fill(-1);
}

LineWire::~LineWire() {
    for (const int file : pulls_)
        if (file >= 0) close(file);
    for (const int file : values_)
        if (file >= 0) close(file);
}

std::expected<LineWire, std::string> LineWire::open(const std::string& chip) {
    LineWire wire;
    const auto file_of = [&chip](unsigned line, const char* name) {
        return chip + "/sim_gpio" + std::to_string(line) + "/" + name;
    };
    const auto missing = [](const std::string& path) {
        return std::unexpected("'" + path + "': " + std::strerror(errno) +
                               "; --gpio-chip wants the folder of a gpio-sim chip with at least " +
                               std::to_string(wires::line::chip_lines) + " lines");
    };
    for (unsigned i = 0; i < wire.pulls_.size(); ++i) {
        const std::string path = file_of(i, "pull");
        wire.pulls_[i] = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
        if (wire.pulls_[i] < 0) return missing(path);
        wire.pull(i, false);
    }
    for (unsigned i = 0; i < wire.values_.size(); ++i) {
        const std::string path = file_of(wires::line::first_output + i, "value");
        wire.values_[i] = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
        if (wire.values_[i] < 0) return missing(path);
    }
    return wire;
}

void LineWire::pull(unsigned input, bool level) {
    const std::string_view word = level ? "pull-up" : "pull-down";
    if (pwrite(pulls_[input], word.data(), word.size(), 0) != static_cast<ssize_t>(word.size())) ++failures_;
    levels_[input] = level;
}

void LineWire::read_output(unsigned output, Plant& plant, Time when) {
    char digit = '0';
    if (pread(values_[output - wires::line::first_output], &digit, 1, 0) == 1)
        plant.set_line(output, digit == '1', when);
    else
        ++failures_;
}

void LineWire::read_outputs(Plant& plant, Time last, Time now) {
    namespace line = wires::line;
    const Time between = last + (now - last) / 2;
    read_output(line::weft_release, plant, between);
    read_output(line::brake, plant, between);
    if (now < slow_at_) return;
    slow_at_ = now + slow_period;
    for (const unsigned output : {line::lamp_run, line::lamp_stop, line::lamp_fault, line::yarn_cutter})
        read_output(output, plant, now);
}

void LineWire::write_inputs(Plant& plant) {
    Edge edge;
    while (plant.next_edge(edge)) pull(edge.line, edge.level);
}

void LineWire::flutter(unsigned input, unsigned edges) {
    const bool level = levels_[input];
    for (unsigned i = 0; i < edges; ++i) pull(input, !levels_[input]);
    if (levels_[input] != level) pull(input, level);
}

} // namespace tappet::loom
