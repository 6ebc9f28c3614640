// Any bytes as a line of a candump log: the reader names the wrong column, or gives a valid frame, and writes
// it back with the same meaning.
#include "drivers/can/candump.hpp"
#include "tests/fuzz/input.hpp"

namespace {

using namespace tappet::can;
using tappet::fuzz::demand;

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view line{reinterpret_cast<const char*>(data), size};
    const auto read = candump::read(line);
    if (!read) {
        demand(!read.error().what.empty() && read.error().column >= 1 && read.error().column <= size + 1);
        demand(size != 0 || read.error().is_cut);
        return 0;
    }
    // The beginning of a right line is cut, or right by itself.
    const auto cut = candump::read(line.substr(0, line.size() - 1));
    demand(cut.has_value() || cut.error().is_cut);
    Frame frame = read->frame;
    demand(frame.stamp >= tappet::Time{} && !read->interface.empty());
    if (read->is_error) return 0;
    demand(valid(frame));
    const tappet::Sentence ours = candump::write(frame, read->interface);
    const auto again = candump::read(ours.view());
    demand(again.has_value());
    frame.stamp = std::chrono::ceil<std::chrono::microseconds>(frame.stamp);
    demand(again->frame == frame);
    return 0;
}
