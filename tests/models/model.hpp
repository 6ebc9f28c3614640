// A model of an algorithm between threads, in Promela: the contents of its first comment, its labels, and the
// results of spin.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace tappet::models {

/// A step of an algorithm: its label and the line that bears it. Labels are the same in model and source,
/// where a dot stands for the first underscore: "ring_pop_look:" and "// ring.pop_look".
using Labels = std::multimap<std::string, std::size_t>;

struct Model {
    std::string name;
    std::string path;
    std::string text;
    std::vector<std::string> sources; ///< the files it is a model of
    std::vector<std::string> twins;   ///< the same algorithm with one fault; each twin is a define of its own
    Labels labels;
};

/// All models of the tree, by name.
const std::vector<Model>& all_models();

[[nodiscard]] std::string read(const std::string& path);
[[nodiscard]] Labels labels_of_source(const std::string& text);
/// Lines that access shared memory without a label and without "// no step: reason".
[[nodiscard]] std::vector<std::string> unlabelled_accesses(const std::string& text);

/// The result of an exhaustive search over every interleaving.
struct Search {
    bool ran = false;      ///< spin, the compiler and the search itself completed
    bool complete = false; ///< no state was left out
    long errors = -1;
    double states = 0;
    std::string error;                  ///< the first violation
    std::vector<std::size_t> unreached; ///< lines of the model that no interleaving executes
    std::string output;
};

/// Searches the model, or its twin when one is named.
[[nodiscard]] Search search(const Model& model, const std::string& twin);

} // namespace tappet::models
