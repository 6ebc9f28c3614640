// A map is checked before it is used: no damage in the machine's memory causes a read outside of it (thesis
// 4.8).
#include "toolchain/tools/browser/map_reader.hpp"

#include "tests/toolchain/tools/browser/sample_machine.hpp"

#include <gtest/gtest.h>

#include <random>

namespace tappet::browser {
namespace {

SampleMap shaft() {
    SampleMap sample;
    const std::uint32_t motion = sample.activity("motion");
    sample.component("shaft", "MainShaft", motion);
    sample.facet("angle", "output", sample.f64, "deg", "of the main shaft", map::facet_can_force);
    const auto point = sample.record("Point", {{"x", sample.f64}, {"y", sample.f64}});
    sample.facet("place", "output", sample.matrix(point, 2, 2, false));
    sample.facet("name", "property", sample.text_type(12));
    sample.facet("knots", "property", sample.sequence(sample.f64, 4));
    sample.connect(0, 1, 1000);
    sample.react("tell", 0, 1);
    sample.figure(map::Owner::activity, 0, "cycles", sample.i32);
    return sample;
}

TEST(MapReader, finds_facets_by_their_full_names) {
    SampleMap sample = shaft();
    const auto block = sample.build();
    const auto map = MapReader::open(block);
    ASSERT_TRUE(map.has_value()) << map.error();
    const auto found = map->find("shaft.angle");
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(map->text(found->record.unit), "deg");
    EXPECT_EQ(map->activity_of(found->record), 0u);
    EXPECT_FALSE(map->find("shaft.angel").has_value());
    EXPECT_TRUE(map->find_component("shaft").has_value());
}

TEST(MapReader, says_why_a_block_is_no_map) {
    SampleMap sample = shaft();
    const auto block = sample.build();
    const auto error_of = [&block](auto change) {
        auto copy = block;
        change(*reinterpret_cast<map::Header*>(copy.data()));
        const auto map = MapReader::open(copy);
        return map ? std::string{} : map.error();
    };
    EXPECT_NE(error_of([](map::Header& header) { header.magic[0] = 'x'; }), "");
    EXPECT_NE(
        error_of([](map::Header& header) { header.layout_version = 99; }).find("built with the firmware"),
        std::string::npos);
    EXPECT_NE(error_of([](map::Header& header) { header.ready = 0; }), "");
    EXPECT_NE(error_of([](map::Header& header) { header.block_bytes *= 2; }), "");
    EXPECT_NE(error_of([](map::Header& header) { header.facets.count = 1'000'000; }), "");
    EXPECT_FALSE(MapReader::open(std::span{block}.first(10)).has_value());
}

TEST(MapReader, refuses_a_type_that_holds_itself) {
    SampleMap sample = shaft();
    auto block = sample.build();
    const map::Header header = sample.header();
    for (std::uint32_t i = 0; i < header.types.count; ++i) {
        auto& type = *reinterpret_cast<map::Type*>(block.data() + header.types.at + i * header.types.stride);
        if (type.shape != map::Shape::record) continue;
        reinterpret_cast<map::Field*>(block.data() + header.fields.at)[type.first_field].type = i;
    }
    const auto map = MapReader::open(block);
    ASSERT_FALSE(map.has_value());
    EXPECT_NE(map.error().find("holds itself"), std::string::npos);
}

/// An address sanitizer would report a read outside; without one, the test checks that each accepted offset
/// is inside.
TEST(MapReader, never_reads_outside_of_a_damaged_block) {
    SampleMap sample = shaft();
    const auto block = sample.build();
    const std::size_t map_bytes = sample.header().map_bytes;
    std::mt19937_64 random{std::random_device{}()};
    int refused = 0;
    for (int round = 0; round < 3000; ++round) {
        auto damaged = block;
        for (int n = 0; n < 1 + round % 4; ++n)
            damaged[random() % map_bytes] = static_cast<std::byte>(random());
        const auto map = MapReader::open(damaged);
        if (!map) {
            ++refused;
            continue;
        }
        const std::uint64_t end = damaged.size();
        for (const map::Facet& facet : map->facets()) {
            if (facet.value_at == 0) continue;
            ASSERT_LT(facet.type, map->types().size());
            ASSERT_LE(facet.value_at + map->types()[facet.type].size, end);
        }
        for (const map::Activity& activity : map->activities()) {
            ASSERT_LE(activity.generation_at + 8, end);
            ASSERT_LE(map->text(activity.name).size(), end);
        }
    }
    EXPECT_GT(refused, 0);
}

} // namespace
} // namespace tappet::browser
