// A list has elements of another type.
// refused: loom: component "shaft" sets property "offsets" to a list of 2, but it is a list, each a number; write set<values>(...) with a constant array of them at namespace scope
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr std::array<bool, 2> values{true, false};
constexpr auto table = [] {
    auto m = good_loom;
    m.components[1] = component<Shaft>("shaft", set<values>("offsets"));
    return m;
}();
template struct tappet::Firmware<table, good_board, good_binding>;
