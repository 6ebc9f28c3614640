// Every algorithm between threads as a model that spin searches exhaustively (thesis 4.4, 4.5, 4.6: no torn
// read, no lost update, no lost wake-up, no use after disconnect); the same algorithm with one fault each
// must be rejected, and the steps of the models are the labelled accesses of the source.
#include "tests/models/model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <set>

namespace tappet::models {
namespace {

bool has_spin() {
    static const bool has = !search(all_models().front(), "").output.contains("spin: not found");
    return has;
}

struct Case {
    const Model* model = nullptr;
    std::string twin;
};
void PrintTo(const Case& one, std::ostream* out) {
    *out << one.model->name << (one.twin.empty() ? "" : " with ") << one.twin;
}
std::string name(const testing::TestParamInfo<Case>& one) {
    return one.param.model->name + (one.param.twin.empty() ? "" : "_" + one.param.twin);
}
std::vector<Case> good() {
    std::vector<Case> cases;
    for (const Model& model : all_models()) cases.push_back({&model, ""});
    return cases;
}
std::vector<Case> broken() {
    std::vector<Case> cases;
    for (const Model& model : all_models())
        for (const std::string& twin : model.twins) cases.push_back({&model, twin});
    return cases;
}

class Algorithm : public testing::TestWithParam<Case> {};

TEST_P(Algorithm, keeps_its_promises_in_every_interleaving) {
    if (!has_spin()) GTEST_SKIP() << "spin is not installed; ci/setup does it";
    const Model& model = *GetParam().model;
    const Search result = search(model, "");
    ASSERT_TRUE(result.ran) << result.output;
    EXPECT_TRUE(result.complete) << result.output;
    EXPECT_EQ(result.errors, 0) << result.error;
    EXPECT_GT(result.states, 100) << "so small a space shows nothing";
    std::cout << model.name << ": " << result.states << " states, " << model.labels.size()
              << " labelled steps, " << model.twins.size() << " twins\n";
    for (const auto& [label, line] : model.labels)
        for (const std::size_t at : {line, line + 1})
            EXPECT_EQ(std::ranges::count(result.unreached, at), 0) << "no interleaving comes to " << label;
}
INSTANTIATE_TEST_SUITE_P(Model, Algorithm, testing::ValuesIn(good()), name);

class Twin : public testing::TestWithParam<Case> {};

TEST_P(Twin, is_rejected) {
    if (!has_spin()) GTEST_SKIP() << "spin is not installed; ci/setup does it";
    const Search result = search(*GetParam().model, GetParam().twin);
    ASSERT_TRUE(result.ran) << result.output;
    EXPECT_GT(result.errors, 0) << "a model that does not see this fault shows nothing";
    std::cout << GetParam().twin << ": " << result.error << "\n";
}
INSTANTIATE_TEST_SUITE_P(Broken, Twin, testing::ValuesIn(broken()), name);

TEST(Models, have_twins_that_each_occur_in_the_model) {
    ASSERT_FALSE(all_models().empty());
    for (const Model& model : all_models()) {
        EXPECT_FALSE(model.twins.empty()) << model.name;
        EXPECT_FALSE(model.sources.empty()) << model.name;
        for (const std::string& twin : model.twins)
            EXPECT_TRUE(model.text.contains("TWIN_" + twin)) << model.name << " does not use " << twin;
    }
}

TEST(Models, take_the_same_steps_as_the_source) {
    std::set<std::string> sources;
    std::set<std::string> modelled;
    for (const Model& model : all_models()) {
        std::set<std::string> here;
        for (const std::string& source : model.sources) {
            sources.insert(source);
            for (const auto& [label, line] : labels_of_source(read(TAPPET_TREE "/" + source)))
                here.insert(label);
        }
        for (const auto& [label, line] : model.labels) {
            modelled.insert(label);
            EXPECT_TRUE(label.starts_with("end_") || here.contains(label))
                << model.path << ":" << line << ": no line of its sources bears \"" << label << "\"";
        }
    }
    for (const std::string& source : sources) {
        const std::string text = read(TAPPET_TREE "/" + source);
        ASSERT_FALSE(text.empty()) << source << " is not there";
        for (const auto& [label, line] : labels_of_source(text))
            EXPECT_TRUE(modelled.contains(label)) << source << ":" << line << ": no model takes this step";
        for (const std::string& line : unlabelled_accesses(text))
            ADD_FAILURE() << source << ": an access without a label: " << line
                          << "; cure: name the model's step, or say \"// no step: \" and why";
    }
}

TEST(Labels, are_found_only_at_the_end_of_a_line) {
    const Labels labels =
        labels_of_source("a.store(1); // ring.push\n// see ring.push for more\nb(); // of a.b c\n");
    ASSERT_EQ(labels.size(), 1u);
    EXPECT_EQ(labels.begin()->first, "ring_push");
    EXPECT_EQ(labels.begin()->second, 1u);
}

TEST(Labels, are_required_on_every_access) {
    EXPECT_EQ(unlabelled_accesses("head_.store(1, order);\n").size(), 1u);
    EXPECT_EQ(unlabelled_accesses("x.fetch_or(1); // no step\n").size(), 1u);
    EXPECT_EQ(unlabelled_accesses("store_pair(place, from);\n").size(), 1u);
    EXPECT_TRUE(unlabelled_accesses("head_.store(1, order); // ring.release\n").empty());
    EXPECT_TRUE(unlabelled_accesses("x.load(); // no step: a count that nobody acts upon\n").empty());
    EXPECT_TRUE(unlabelled_accesses("cell.value.load(copy);\n").empty());
}

} // namespace
} // namespace tappet::models
