// How deep a thread may use its stack, from the object code of a whole program.
//
// A function's frame is followed through its instructions, path by path; a call adds what the callee needs. A
// call through a pointer is resolved by layers: whatever is called through a pointer lies in a lower layer
// than its caller, or in one that may be entered several times, as often as stated.
//
// A fault is: a frame of variable size, a recursion, missing code, a call through a pointer outside of all
// layers, and a function whose address is taken without a stated layer.
//
// Not seen: whether the layers are true (they are the framework's design, and the high-water mark of a run
// contradicts wrong ones); code after a broken contract or the program's end, which `ends` cuts off; signal
// handlers, which the threads of a machine block; the kernel's vdso.
#pragma once

#include "tests/waitfree/disassembly.hpp"

#include <cstddef>
#include <map>
#include <set>

#include <string>
#include <string_view>
#include <vector>

namespace tappet::stack_bound {

/// Functions whose demangled name contains one of these.
using Names = std::vector<std::string_view>;

struct Layer {
    std::string_view what;
    Names of;
    std::size_t times = 1;   ///< how often one path enters it through pointers
    std::string_view only{}; ///< entered only where of() allows this of the topmost layer; empty: everywhere
};

/// A call that is not followed, because its code is missing or never runs.
struct Statement {
    std::string_view name; ///< how the demangled name begins
    std::size_t bytes;     ///< at most
    std::string_view why;
};

/// A function that calls itself, directly or through others.
struct Recursion {
    std::string_view name; ///< how the demangled name begins
    std::size_t times;     ///< entered at most this often
    std::string_view why;
};

struct Rules {
    std::vector<Layer> layers; ///< the lowest first
    Names ends;                ///< do not return, and are not followed
    Names outside;             ///< called through a pointer before or beside the threads; not followed
    std::vector<Statement> stated;
    std::vector<Recursion> recurring;
};

/// The targets of calls whose function libc picks for the processor at program start.
inline constexpr std::string_view picked_at_start = "(picked at start)";

/// A linked program: its code, and the functions whose addresses stand in its data or code.
struct Image {
    waitfree::Program functions;
    std::set<std::string> taken;
    std::size_t thread_local_bytes = 0; ///< placed at the top of each thread's stack
};
/// Empty when the file or objdump is missing.
[[nodiscard]] Image read_image(const std::string& path);

[[nodiscard]] std::string demangled(const std::string& name);

class Bounds {
public:
    Bounds(const Image& image, const Rules& rules);

    /// The need in bytes of a thread that begins in `root`; in the topmost layer, it calls through pointers
    /// only what `allowed` names. Excludes the needs of faults() met on the way.
    [[nodiscard]] std::size_t of(std::string_view root, Names allowed);
    /// The deepest path of the last of(): one function a line, with its need and that of those below it.
    [[nodiscard]] std::string path() const;
    [[nodiscard]] const std::set<std::string>& faults() const { return faults_; }

private:
    struct Call {
        std::size_t depth = 0; ///< bytes in use at the call, including its return address
        std::string to;        ///< empty: through a pointer
    };
    struct Frame {
        std::size_t deepest = 0;
        std::vector<Call> calls;
        std::string fault;
    };
    static constexpr std::size_t no_layer = ~std::size_t{0};

    [[nodiscard]] Frame frame_of(const waitfree::Function& function) const;
    void fault(const std::string& function, const std::string& what);
    struct Need {
        std::size_t bytes = 0;
        std::pair<std::string, std::size_t>
            next{}; ///< the call with the largest need, and its layer; without a call: no name
    };
    [[nodiscard]] std::size_t need_of(const std::string& name, std::size_t layer);
    [[nodiscard]] const Need& need_below(std::size_t layer);
    [[nodiscard]] std::size_t layer_of(const std::string& name) const;
    [[nodiscard]] const Frame& frame(const std::string& name);

    const Image& image_;
    const Rules& rules_;
    std::map<std::string, Frame> frames_;
    std::map<std::pair<std::string, std::size_t>, Need> needs_;
    std::map<std::pair<std::string, std::size_t>, Need>
        ways_; // the same, including needs cut off by a recursion
    std::map<std::size_t, Need> below_;
    std::pair<std::string, std::size_t> root_{};
    std::vector<std::string> path_;
    static constexpr std::size_t nowhere = ~std::size_t{0};
    std::size_t cut_at_ = nowhere; // the place in path_ to which a recursion returned
    std::set<std::string> faults_;
    std::vector<std::vector<std::string>> of_layer_;
    Names allowed_{};
};

} // namespace tappet::stack_bound
