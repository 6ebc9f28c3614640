// How init looks at processes.
#include "board/init/system.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::init {
namespace {

TEST(Children, exclude_grandchildren) {
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        ::prctl(PR_SET_NAME, "a) S 1 (");
        const pid_t grandchild = ::fork();
        if (grandchild == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL); // before anybody kills its parent
            const pid_t own = ::getpid();
            [[maybe_unused]] const auto n = ::write(ready[1], &own, sizeof own);
        }
        for (;;) ::pause();
    }
    pid_t grandchild = 0;
    ASSERT_EQ(::read(ready[0], &grandchild, sizeof grandchild), static_cast<ssize_t>(sizeof grandchild));
    EXPECT_THAT(children_of(::getpid()), testing::Contains(child));
    EXPECT_THAT(children_of(::getpid()), testing::Not(testing::Contains(grandchild)));
    EXPECT_THAT(children_of(child), testing::ElementsAre(grandchild)) << "whatever it calls itself";
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    ::close(ready[0]);
    ::close(ready[1]);
}

} // namespace
} // namespace tappet::init
