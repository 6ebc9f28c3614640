// The binding says nothing of a device of that name.
// refused: loom: component "encoder": the binding to board "bench" has no wired(...) for device "main_encodr"; did you mean "main_encoder"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = [] {
    auto m = good_loom;
    m.components[0].device = "main_encodr";
    return m;
}();
template struct tappet::Firmware<table, good_board, good_binding>;
