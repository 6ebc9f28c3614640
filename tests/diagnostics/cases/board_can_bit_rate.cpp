// The board's CAN device does not say at which bit rate its bus runs.
// refused: loom: component "encoder": device "main_encoder" of board "old box" states no bit rate; add bit_rate(500'000), or what its bus runs at, to it
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
constexpr Board other_board{
    .name = "old box",
    .memory_budget_bytes = 1'000'000,
    .devices = {
        {{board_device("main_encoder", "can", "can0"), board_device("hall", "modbus", "192.168.7.2:502"),
          board_device("panel", "gpio", "/dev/gpiochip0", line("red", 4), line("green", 5))}},
        3}};

constexpr auto table =
    loom(good_components, good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, other_board>;
