// Any bytes as a DBC file: the reader refuses with a sentence that names a line, or gives a map whose frames
// encode back as they were decoded; it never reads outside its text and always ends. The check of the whole
// file tells each fault with a line of the file, and one for each map that is refused for an unreadable file.
#include "drivers/can/signal_store.hpp"
#include "tests/drivers/can/dbc_on_host.hpp"
#include "tests/fuzz/input.hpp"
#include "toolchain/tools/check/check.hpp"

#include <algorithm>

namespace {

using namespace tappet::can;
using tappet::fuzz::demand;

constexpr auto us = node("us");

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static_assert(us.frames.empty());
    const std::string_view text{reinterpret_cast<const char*>(data), size};
    const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1;
    bool is_readable = true;
    for (const tappet::checking::Finding& each : tappet::checking::check_dbc(text)) {
        demand(each.line >= 1 && each.line <= lines && !each.meaning.empty());
        is_readable &= each.weight != tappet::checking::Weight::unreadable;
    }
    const DbcMap read{text, us.view()};
    demand(is_readable || !read.map.fault.empty());
    if (!read.map.fault.empty()) {
        demand(!read.map.fault.view().contains(": ;")); // the second reading found the fault again
        demand(read.map.fault.view().starts_with("t.dbc:") ||
               read.map.fault.view() == "too large for this test");
        return 0;
    }
    for (std::size_t f = 0; f < read.sizes.frames; ++f) {
        SignalStore store{read.map};
        Frame frame;
        frame.id = read.map.frames[f].identifier.id;
        frame.extended = read.map.frames[f].identifier.extended;
        frame.length = read.map.frames[f].length;
        frame.data.fill(0xA5);
        std::size_t which = tappet::no_such;
        demand(store.decode(frame, which) == Decoded::yes && which == f);
        const Frame again = store.encode(f, {});
        SignalStore second{read.map};
        demand(second.decode(again) == Decoded::yes);
        for (std::size_t s = read.map.frames[f].first; s < read.map.frames[f].end(); ++s)
            demand(store.integer(s) == second.integer(s));
    }
    return 0;
}
