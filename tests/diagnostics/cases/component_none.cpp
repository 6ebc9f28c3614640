// A table without components.
// refused: loom: the table has no components; add component<Type>("name") rows to components(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(components(), activities(), connections(), reactions(), behaviours());
template struct tappet::Firmware<table, good_board, good_binding>;
