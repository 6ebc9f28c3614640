// DBC files of some seeds as the compiler read them, beside the same reader at run time.
#include "tests/drivers/can/generated_dbc.hpp"
#include "tests/drivers/can/same_map.hpp"

#include <gtest/gtest.h>

namespace tappet::can {
namespace {

TEST(DbcCompiled, equals_the_map_read_at_run_time) {
    expect_same(generated::map_1, {generated::file_1.text, generated::node_1.view()});
    expect_same(generated::map_2, {generated::file_2.text, generated::node_2.view()});
    expect_same(generated::map_3, {generated::file_3.text, generated::node_3.view()});
    expect_same(generated::map_4, {generated::file_4.text, generated::node_4.view()});
    expect_same(generated::map_5, {generated::file_5.text, generated::node_5.view()});
    expect_same(generated::map_6, {generated::file_6.text, generated::node_6.view()});
}

} // namespace
} // namespace tappet::can
