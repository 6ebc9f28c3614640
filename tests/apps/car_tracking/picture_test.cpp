// Thesis 5.4: the picture of a run shows its track, its states and the sightings; the program draws it or
// says why not.
#include "apps/car_tracking/host/picture.hpp"
#include "tests/toolchain/folder.hpp"
#include "tests/toolchain/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tappet::car_tracking {
namespace {

using ::testing::HasSubstr;

std::size_t count(std::string_view text, std::string_view word) {
    std::size_t n = 0;
    for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++n;
    return n;
}

TEST(Picture, shows_every_located_car_and_every_image) {
    const std::vector<Moment> moments{{0.0, 1, 1, false, 2, 1, "Waiting"},
                                      {1.0, 1.1, 1, true, 2, 1, "LocaliseCar"},
                                      {2.0, 1.2, 1, false, 2, 1, "Shutdown"}};
    const std::vector<Look> looks{{1.0, true, true, 1.1, 1.0, 1.1, 1.0, false},
                                  {1.5, false, false, 0, 0, 1.2, 1.0, true}};
    const std::string picture = picture_of(moments, looks);
    EXPECT_EQ(count(picture, "<svg"), 1u);
    EXPECT_EQ(count(picture, "</svg>"), 1u);
    EXPECT_EQ(count(picture, "fill=\"#c8202a\"/>"), 3u) << "on the map, in the legend, in the errors";
    EXPECT_EQ(count(picture, "stroke=\"#c8202a\""), 1u) << "one image without the car";
    for (const auto* state : {"Startup", "Waiting", "Positioning", "Calibration", "LocaliseCar"})
        EXPECT_THAT(picture, HasSubstr(state));
}

TEST(Picture, shows_the_room_without_data) { EXPECT_THAT(picture_of({}, {}), HasSubstr("tunnel")); }

TEST(Program, draws_its_picture_or_says_why_not) {
    const test::Folder folder;
    const std::string file = folder / "car_tracking_test.svg";
    const Ended drawn = run_line(CAR_TRACKING " --virtual --seed 1 --for 2 --picture '" + file + "'");
    EXPECT_EQ(drawn.exit_code, 0) << drawn.text;
    EXPECT_THAT(drawn.text, HasSubstr("the plant measured {\"images\": 0"));
    EXPECT_THAT(test::contents_of(file), HasSubstr("</svg>"));

    const Ended nowhere = run_line(CAR_TRACKING " --for 1 --picture /nowhere/at/all.svg");
    EXPECT_EQ(nowhere.exit_code, 2);
    EXPECT_THAT(nowhere.text, HasSubstr("the picture cannot be written to \"/nowhere/at/all.svg\"; name a"));
}

TEST(Program, refuses_real_time) {
    const Ended ended = run_line(CAR_TRACKING " --real --for 1");
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_THAT(ended.text, HasSubstr("option --real: this program stops its machine to look into it"));
}

} // namespace
} // namespace tappet::car_tracking
