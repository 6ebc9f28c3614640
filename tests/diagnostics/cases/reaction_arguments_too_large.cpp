// An asynchronous reaction's arguments do not fit one message.
// refused: loom: reaction "camera.seen" -> "camera.show": its 56 bytes of arguments exceed the 48 bytes of a message; send them through a port
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
struct Picture {
    std::array<double, 7> rows{};
};
struct Camera {
    Event<Picture> seen;
    void show(Picture) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(event<&Camera::seen>("seen", "a picture"),
                      operation<&Camera::show>("show", "to the operator"));
    }
};

constexpr auto table =
    loom(components(component<Encoder>("encoder", device("main_encoder")), component<Shaft>("shaft"),
                    component<Tension>("tension"), component<Weft>("weft"),
                    component<Climate>("climate", device("hall")), component<Lamps>("lamps", device("panel")),
                    component<Camera>("camera")),
         activities(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                             runs("encoder")),
                    activity("motion", every(1ms), budget(120us), runs("shaft", "tension")),
                    activity("logic", on_work(), at_most(4, 10ms), deadline(2ms), budget(80us),
                             runs("weft", "lamps", "camera")),
                    activity("hall", every(250ms), not_real_time, runs("climate"))),
         good_connections,
         reactions(when("encoder.index", tell("shaft.on_index")), when("camera.seen", tell("camera.show"))),
         good_behaviours);
template struct tappet::Firmware<table, good_board>;
