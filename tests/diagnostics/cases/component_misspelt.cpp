// A row of components(...) is misspelt; all the other rows are right.
// refused: loom: component "encodr" is named in no other row, but 4 rows name "encoder", which is not in components(...); rename it to that
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = [] {
    auto m = good_loom;
    m.components[0].name = "encodr";
    return m;
}();
template struct tappet::Firmware<table, good_board, good_binding>;
