// DBC files of some seeds as the compiler read them, beside the same reader at run time.
#include "tests/drivers/can/generated_dbc.hpp"
#include "tests/drivers/can/same_map.hpp"

#include <gtest/gtest.h>

namespace tappet::can {
namespace {

TEST(DbcCompiled, equals_the_map_read_at_run_time) {
    expect_same(generated::map_1, {generated::text_1, generated::node_1.view()});
    expect_same(generated::map_2, {generated::text_2, generated::node_2.view()});
    expect_same(generated::map_3, {generated::text_3, generated::node_3.view()});
    expect_same(generated::map_4, {generated::text_4, generated::node_4.view()});
    expect_same(generated::map_5, {generated::text_5, generated::node_5.view()});
    expect_same(generated::map_6, {generated::text_6, generated::node_6.view()});
}

} // namespace
} // namespace tappet::can
