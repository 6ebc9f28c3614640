// Follows the stack pointer through each function, and the calls through the program.
#include "tests/stack/bounds.hpp"

#include <algorithm>

#include <cstdlib>
#include <cxxabi.h>
#include <memory>
#include <optional>
#include <utility>

namespace tappet::stack_bound {

namespace {

using waitfree::Function;
using waitfree::Instruction;

constexpr std::int64_t word = 8;

bool names(const Names& list, const std::string& text) {
    return std::ranges::any_of(list,
                               [&](std::string_view each) { return text.find(each) != std::string::npos; });
}

std::optional<std::int64_t> number(std::string_view text) {
    return text.contains("0x") ? waitfree::as_number(text) : std::nullopt;
}

/// Differs from waitfree's values.hpp, which keeps only facts that all paths share and forgets the frame in
/// which an alignment begins; here the deepest path counts. Holds the depth below the function's entry, the
/// registers that keep another stack pointer, and the depth last compared with the stack pointer.
struct Height {
    std::int64_t used = 0;
    std::map<std::string, std::int64_t, std::less<>> kept{};
    std::optional<std::int64_t> compared{};
};

/// "[rsp+0x10]": the register and the distance.
std::optional<std::pair<std::string_view, std::int64_t>> address(std::string_view text) {
    if (!text.starts_with('[') || !text.ends_with(']')) return {};
    text = text.substr(1, text.size() - 2);
    const std::size_t sign = text.find_first_of("+-");
    if (sign == text.npos) return std::pair{text, std::int64_t{0}};
    const auto by = number(text.substr(sign));
    if (!by) return {};
    return std::pair{text.substr(0, sign), *by};
}

/// False: the stack pointer is no longer known.
bool execute(const Instruction& one, Height& height) {
    const auto operand = [&](std::size_t i) {
        return i < one.operands.size() ? std::string_view{one.operands[i]} : std::string_view{};
    };
    const std::string_view to = operand(0), from = operand(1);
    const auto restore = [&](std::string_view kept, std::int64_t by) {
        const auto found = height.kept.find(kept);
        if (found == height.kept.end()) return false;
        height.used = found->second - by;
        return true;
    };
    const auto compared = std::exchange(height.compared, {});
    if (one.is("cmp") && to == "rsp" && height.kept.contains(from))
        height.compared = height.kept.find(from)->second;
    if (one.is("jne")) height.compared = compared;
    if (one.is("push") || one.is("pushf")) {
        height.used += word;
        return true;
    }
    if (one.is("pop") || one.is("popf")) height.used -= word;
    if (one.is("leave")) return restore("rbp", 0) && (height.used -= word, true);
    if (one.is("mov") && from == "rsp") {
        height.kept[std::string{to}] = height.used;
        return true;
    }
    if (to != "rsp") {
        if (const auto place = address(from); one.is("lea") && place && place->first == "rsp") {
            height.kept[std::string{to}] = height.used - place->second;
            return true;
        }
        if (const auto by = number(from); one.is("sub") && by && height.kept.contains(to)) {
            height.kept[std::string{to}] += *by;
            return true;
        }
        if (!one.is("cmp") && !one.is("test")) height.kept.erase(std::string{to});
        return true;
    }
    if (one.is("cmp") || one.is("test")) return true;
    if (one.is("mov")) return restore(from, 0);
    if (one.is("lea")) {
        const auto place = address(from);
        if (!place) return false;
        if (place->first == "rsp") {
            height.used -= place->second;
            return true;
        }
        // The end of an aligned frame: g++ keeps the pointer at entry in r10, and then in the frame.
        if (place->first == "r10") height.used = 0;
        return place->first == "r10" || restore(place->first, place->second);
    }
    const auto by = number(from);
    if (!by) return false;
    if (one.is("sub"))
        height.used += *by;
    else if (one.is("add"))
        height.used -= *by;
    else if (one.is("and")) // aligns: the mask removes at most this much
        height.used += -*by - 1;
    else
        return false;
    return true;
}

} // namespace

std::string demangled(const std::string& name) {
    int status = 0;
    const std::string plain = name.substr(0, std::min(name.find('@'), name.find(".cold")));
    const std::unique_ptr<char, void (*)(void*)> text{
        abi::__cxa_demangle(plain.c_str(), nullptr, nullptr, &status), std::free};
    return status == 0 ? text.get() : name;
}

Bounds::Bounds(const Image& image, const Rules& rules) : image_{image}, rules_{rules} {
    of_layer_.resize(rules.layers.size());
    for (const std::string& name : image.taken) {
        const std::size_t layer = layer_of(name);
        const std::string text = demangled(name);
        if (layer != no_layer)
            of_layer_[layer].push_back(name);
        else if (text.find("tappet::") != text.npos && !names(rules.outside, text))
            faults_.insert(text + ": its address is taken, and no layer says by whom it is called");
    }
}

std::size_t Bounds::layer_of(const std::string& name) const {
    const std::string text = demangled(name);
    for (std::size_t i = 0; i < rules_.layers.size(); ++i)
        if (names(rules_.layers[i].of, text)) return i;
    return no_layer;
}

void Bounds::fault(const std::string& function, const std::string& what) {
    std::string chain;
    for (std::size_t i = path_.size() > 14 ? path_.size() - 14 : 0; i < path_.size(); ++i)
        chain += demangled(path_[i]) + " -> ";
    faults_.insert(chain + demangled(function) + ": " + what);
}

Bounds::Frame Bounds::frame_of(const Function& function) const {
    Frame frame;
    const auto& code = function.code;
    std::map<std::size_t, Height> seen;
    std::vector<std::pair<std::size_t, Height>> next{{0, {}}};
    const auto follow = [&] {
        while (!next.empty()) {
            auto [at, height] = next.back();
            next.pop_back();
            const auto [found, is_new] = seen.try_emplace(at, height);
            if (!is_new && found->second.used >= height.used) continue;
            found->second = height;
            if (height.used > (1 << 24)) {
                frame.fault = "its frame grows in a loop";
                frame.deepest = 0;
                frame.calls.clear();
                return;
            }
            const Instruction& one = code[at];
            if (!execute(one, height)) {
                frame.fault = "its frame has no constant size: " + one.mnemonic;
                return;
            }
            const auto depth = static_cast<std::size_t>(std::max<std::int64_t>(height.used, 0));
            frame.deepest = std::max(frame.deepest, depth);
            const bool ends = !one.symbol.empty() && names(rules_.ends, demangled(one.symbol));
            if (one.is_call() && !ends)
                frame.calls.push_back({depth + std::size_t{word}, one.symbol});
            else if (!ends && !one.symbol.empty() && one.symbol != "(the middle of a function)")
                frame.calls.push_back({depth, one.symbol}); // it continues there
            else if (one.is_jump() && one.target == waitfree::none && one.symbol.empty() && depth == 0)
                frame.calls.push_back({0, {}});
            if (one.is_call() && ends) continue;
            // The loop that touches a large frame page by page, down to the depth that ends it.
            if (height.compared && one.is("jne") && one.target < at && *height.compared >= height.used) {
                height.used = *height.compared;
                frame.deepest = std::max(frame.deepest, static_cast<std::size_t>(height.used));
                next.emplace_back(at + 1, height);
                continue;
            }
            for (const std::size_t each : function.successors(at)) next.emplace_back(each, height);
        }
    };
    follow();
    // Code reached only by a jump table has a complete frame.
    // The cold part of a function is also entered in its middle.
    const bool has_table = function.name.find(".cold") != std::string::npos ||
                           std::ranges::any_of(code, [](const Instruction& one) {
                               return one.is_jump() && one.target == waitfree::none && one.symbol.empty();
                           });
    for (std::size_t at = 0; has_table && at < code.size() && frame.fault.empty(); ++at) {
        if (seen.contains(at)) continue;
        const auto deepest = static_cast<std::int64_t>(frame.deepest);
        next.push_back({at, {deepest, {{"rbp", deepest}}}});
        follow();
    }
    for (const Call& call : frame.calls) frame.deepest = std::max(frame.deepest, call.depth);
    return frame;
}

const Bounds::Frame& Bounds::frame(const std::string& name) {
    const auto [found, is_new] = frames_.try_emplace(name);
    if (is_new) found->second = frame_of(image_.functions.at(name));
    return found->second;
}

std::size_t Bounds::need_of(const std::string& name, std::size_t layer) {
    if (const auto known = needs_.find({name, layer}); known != needs_.end()) return known->second.bytes;
    const std::string text = demangled(name);
    for (const Statement& each : rules_.stated)
        if (text.starts_with(each.name)) return each.bytes;
    if (!image_.functions.contains(name)) {
        fault(name, "its code is not seen");
        return 0;
    }
    if (const auto above = std::ranges::find(path_, name); above != path_.end()) {
        if (std::ranges::none_of(rules_.recurring,
                                 [&](const Recursion& each) { return text.starts_with(each.name); }))
            fault(name, "a recursion");
        cut_at_ = std::min(cut_at_, static_cast<std::size_t>(above - path_.begin()));
        return 0;
    }
    const Frame& own = frame(name);
    if (!own.fault.empty()) fault(name, own.fault);
    const std::size_t cut_before = std::exchange(cut_at_, nowhere), at = path_.size();
    path_.push_back(name);
    Need most{own.deepest, {}};
    const auto weigh = [&most](std::size_t bytes, const std::pair<std::string, std::size_t>& next) {
        if (bytes > most.bytes) most = {bytes, next};
    };
    for (const Call& call : own.calls) {
        if (!call.to.empty()) {
            // A function named by a layer calls lower layers through pointers, even when it is called
            // directly.
            const std::size_t own_layer = layer == no_layer ? layer : std::min(layer, layer_of(call.to));
            weigh(call.depth + need_of(call.to, own_layer), {call.to, own_layer});
        } else if (layer == no_layer) {
            fault(name, "it calls through a pointer, outside of all layers");
        } else {
            const Need& below = need_below(layer);
            weigh(call.depth + below.bytes, below.next);
        }
    }
    path_.pop_back();
    for (const Recursion& each : rules_.recurring)
        if (text.starts_with(each.name)) most.bytes *= each.times;
    ways_[{name, layer}] = most;
    // A need that a recursion cut off is part of its caller's need, and must not be kept for other callers.
    if (cut_at_ >= at) needs_[{name, layer}] = most;
    cut_at_ = std::min(cut_before, cut_at_ < at ? cut_at_ : nowhere);
    return most.bytes;
}

/// The need of a call through a pointer out of this layer: each lower layer counts as often as it states.
const Bounds::Need& Bounds::need_below(std::size_t layer) {
    if (const auto known = below_.find(layer); known != below_.end()) return known->second;
    Need most;
    const auto path = std::exchange(path_, {});
    const std::size_t cut_before = std::exchange(cut_at_, nowhere);
    for (std::size_t lower = 0; lower < layer; ++lower) {
        const auto& [what, of, times, only] = rules_.layers[lower];
        if (!only.empty() && std::ranges::find(allowed_, only) == allowed_.end()) continue;
        // The last of several entries has its full need; each one before it adds its own frames, at most the
        // same.
        for (const std::string& name : of_layer_[lower])
            if (const std::size_t bytes = need_of(name, lower) * times; bytes > most.bytes)
                most = {bytes, {name, lower}};
    }
    path_ = path;
    cut_at_ = cut_before;
    return below_[layer] = most;
}

std::size_t Bounds::of(std::string_view root, Names allowed) {
    needs_.clear();
    ways_.clear();
    below_.clear();
    allowed_ = std::move(allowed);
    const std::size_t top = rules_.layers.size() - 1;
    Need most = need_below(top);
    for (const std::string& name : of_layer_[top])
        if (names(allowed_, demangled(name)) && need_of(name, top) > most.bytes)
            most = {need_of(name, top), {name, top}};
    for (const std::string_view each : allowed_)
        if (std::ranges::none_of(of_layer_[top],
                                 [&](const std::string& name) { return names({each}, demangled(name)); }))
            faults_.insert(std::string{each} + ": nothing of the topmost layer has that name");
    below_[top + 1] = most;
    for (const auto& [name, function] : image_.functions)
        if (demangled(name) == root) {
            root_ = {name, top + 1};
            return image_.thread_local_bytes + need_of(name, top + 1);
        }
    faults_.insert(std::string{root} + ": it is not in the program");
    return 0;
}

std::string Bounds::path() const {
    std::string text;
    for (auto at = root_; !at.first.empty();) {
        const auto need = ways_.find(at);
        text += "    " + (need == ways_.end() ? std::string{"?"} : std::to_string(need->second.bytes)) + " " +
                demangled(at.first) + "\n";
        at = need == ways_.end() ? decltype(at){} : need->second.next;
    }
    return text;
}

} // namespace tappet::stack_bound
