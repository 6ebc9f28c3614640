// The value before the first one is of another type than the port.
// refused: loom: connection "shaft.speed" -> "tension.speed": initially gives a value of type float, but "tension.speed" is of type double; name a constant of the port's type
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr float standing = 0;
constexpr auto table = loom(good_components, good_activities,
                            connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                                        data("shaft.speed", "tension.speed", initially<standing>()),
                                        data("weft.reference", "shaft.reference")),
                            good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
