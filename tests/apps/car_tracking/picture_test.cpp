// Thesis 5.4: the picture of a run shows its track, its states and what was seen; the command line says what
// it does not take.
#include "apps/car_tracking/host/options.hpp"
#include "apps/car_tracking/host/picture.hpp"

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

TEST(Picture, of_nothing_is_a_picture_of_the_room) { EXPECT_THAT(picture_of({}, {}), HasSubstr("tunnel")); }

TEST(Options, take_a_seed_a_time_and_a_file) {
    const std::array words{"car_tracking", "--virtual", "--seed",    "7",
                           "--seconds",    "20",        "--picture", "a.svg"};
    const auto options = parse_options(static_cast<int>(words.size()), words.data());
    ASSERT_TRUE(options) << options.error().view();
    EXPECT_EQ(options->seed, 7u);
    EXPECT_EQ(options->seconds, 20u);
    EXPECT_EQ(options->picture, "a.svg");
}

TEST(Options, refuse_with_the_cure) {
    const auto refusal = [](std::vector<const char*> words) {
        words.insert(words.begin(), "car_tracking");
        const auto options = parse_options(static_cast<int>(words.size()), words.data());
        return options ? std::string{} : std::string{options.error().view()};
    };
    EXPECT_EQ(refusal({"--sed", "1"}), "option --sed is unknown; did you mean --seed");
    EXPECT_EQ(refusal({"--seed"}), "option --seed needs a value after it; see --help");
    EXPECT_EQ(refusal({"--seed", "1x"}),
              "option --seed: \"1x\" is not a whole number; write for example --seed 60");
    EXPECT_EQ(refusal({"--seconds", "0"}), "option --seconds: a run takes from 1 to 3600 s");
}

} // namespace
} // namespace tappet::car_tracking
