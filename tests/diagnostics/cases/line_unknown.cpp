// The board's device has no line that the driver wants.
// refused: loom: component "lamps": device "panel" of board "old box" has no line "green"; did you mean "greeen"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
constexpr Board other_board{
    .name = "old box",
    .memory_budget_bytes = 1'000'000,
    .devices = {{{board_device("main_encoder", "can", "can0", bit_rate(500'000)),
                  board_device("hall", "modbus", "192.168.7.2:502"),
                  board_device("panel", "gpio", "/dev/gpiochip0", line("red", 4), line("greeen", 5))}},
                3}};

constexpr auto table =
    loom(good_components, good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, other_board>;
