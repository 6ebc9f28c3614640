// Saving properties from outside (thesis 4.7.1, 4.8): a browser's changes outlive the machine.
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

TEST_F(Saving, writes_changed_properties_and_reports_the_number_of_files) {
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

TEST_F(Saving, requires_a_properties_file_of_the_component) {
    EXPECT_TRUE(has(ask("1 save ram"), R"("files": 1)"));
    EXPECT_TRUE(has(ask("2 save table"), "has no properties file; give its row"));
    EXPECT_TRUE(has(ask("3 save rma"), R"(did you mean \"ram\"?)"));
}

TEST_F(Saving, reports_a_failure_and_keeps_the_old_file) {
    EXPECT_TRUE(has(ask("1 save"), R"("files": 1)"));
    const std::string before = kept();
    std::filesystem::create_directory(directory + "/ram.cpf.tappet-new"); // the path of the new file
    EXPECT_TRUE(has(ask("2 set ram.speed 3"), R"("set": 1)"));
    EXPECT_TRUE(has(ask("3 save"), "the old file remains"));
    EXPECT_EQ(kept(), before);
}

TEST_F(Saving, gives_up_on_a_hung_engine_and_can_be_repeated) {
    Engine& engine = hang(0);
    for (int i = 0; i < 3; ++i) {
        const std::string answer = ask("1 save", 3s);
        EXPECT_TRUE(has(answer, R"("code": "not_now")") &&
                    has(answer, R"(look at activity \"motion\"; the old file remains)"));
    }
    engine.start(clock.now());
    run(100ms);
    EXPECT_EQ(kept(), "") << "what was called not saved is not saved later";
    EXPECT_TRUE(has(ask("2 save"), R"("files": 1)"));
}

} // namespace
} // namespace tappet::press
