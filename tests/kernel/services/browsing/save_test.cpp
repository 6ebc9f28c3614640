// Saving properties from outside (thesis 4.7.1, 4.8): what a browser changed outlives the machine.
#include "tests/kernel/services/browsing/press_rig.hpp"

#include <fstream>
#include <iterator>

namespace tappet::press {
namespace {

class Saving : public Press {
protected:
    [[nodiscard]] std::string kept() const {
        std::ifstream file{directory + "/ram.cpf"};
        return {std::istreambuf_iterator<char>{file}, {}};
    }
};

TEST_F(Saving, writes_what_was_set_and_says_how_many_files) {
    EXPECT_EQ(kept(), "");
    EXPECT_TRUE(has(ask("1 set ram.speed 2.5 ram.force 40"), R"("set": 2)"));
    EXPECT_TRUE(has(ask("2 save"), R"("id": 2, "ok": true, "files": 1)"));
    EXPECT_TRUE(has(kept(), "<value>2.5</value>")) << kept();
    PropertyTransaction again;
    Ram ram_of_tomorrow;
    again.begin("ram", component_type<Ram>, &ram_of_tomorrow);
    EXPECT_TRUE(read_cpf(kept(), "ram.cpf", again).empty());
    again.commit();
    EXPECT_EQ(ram_of_tomorrow.speed.get(), 2.5);
    EXPECT_EQ(ram_of_tomorrow.force.get(), 40.0);
}

TEST_F(Saving, of_one_component_needs_one_that_has_a_file) {
    EXPECT_TRUE(has(ask("1 save ram"), R"("files": 1)"));
    EXPECT_TRUE(has(ask("2 save table"), "has no properties file; give its row"));
    EXPECT_TRUE(has(ask("3 save rma"), R"(did you mean \"ram\"?)"));
}

TEST_F(Saving, that_cannot_be_done_says_why_and_leaves_the_old_file) {
    EXPECT_TRUE(has(ask("1 save"), R"("files": 1)"));
    const std::string before = kept();
    std::filesystem::create_directory(directory + "/ram.cpf.new"); // where the new one would be written
    EXPECT_TRUE(has(ask("2 set ram.speed 3"), R"("set": 1)"));
    EXPECT_TRUE(has(ask("3 save"), "the old file stands"));
    EXPECT_EQ(kept(), before);
}

TEST_F(Saving, of_an_engine_that_does_not_come_is_given_up_and_keeps_nobody_from_saving_again) {
    Engine& engine = hang(0);
    for (int i = 0; i < 3; ++i) {
        const std::string answer = ask("1 save", 3s);
        EXPECT_TRUE(has(answer, R"("code": "not_now")") &&
                    has(answer, R"(look at activity \"motion\"; the old file stands)"));
    }
    engine.start(clock.now());
    run(100ms);
    EXPECT_EQ(kept(), "") << "what was called not saved is not saved later";
    EXPECT_TRUE(has(ask("2 save"), R"("files": 1)"));
}

} // namespace
} // namespace tappet::press
