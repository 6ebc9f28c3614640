// Reads value change dumps as IEEE 1364-2005, clause 18, describes them: written from the standard, not from
// the writer under test.
#pragma once

#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace tappet::browser {

/// From one rise to the fall that follows.
using Pulse = std::pair<std::int64_t, std::int64_t>;

class VcdReader {
public:
    explicit VcdReader(const std::string& text) : words_{text} { read(); }
    [[nodiscard]] const std::string& fault() const { return fault_; } ///< empty: the file is sound
    [[nodiscard]] const std::string& timescale() const { return timescale_; }
    [[nodiscard]] std::int64_t end() const { return time_; }
    /// The pulses of each wire by its full name, "top.motion.runs".
    [[nodiscard]] const std::map<std::string, std::vector<Pulse>>& pulses() const { return pulses_; }

private:
    struct Wire {
        std::string name;
        bool is_up = false;
        bool has_value = false;
        std::int64_t since = 0;
    };

    void fail(const std::string& what) {
        if (fault_.empty()) fault_ = what;
    }
    std::vector<std::string> until_end() {
        std::vector<std::string> found;
        std::string word;
        while (words_ >> word && word != "$end") found.push_back(word);
        if (word != "$end") fail("a section without $end");
        return found;
    }
    void declare(const std::string& keyword) {
        const std::vector<std::string> body = until_end();
        if (keyword == "$scope") {
            if (body.size() != 2 || body[0] != "module") return fail("a scope that is no module");
            scopes_.push_back(body[1]);
        } else if (keyword == "$upscope") {
            if (scopes_.empty()) return fail("more $upscope than $scope");
            scopes_.pop_back();
        } else if (keyword == "$var") {
            if (body.size() != 4 || body[0] != "wire" || body[1] != "1")
                return fail("a variable that is no wire of one bit");
            for (const char character : body[2])
                if (character < '!' || character > '~')
                    return fail("an identifier code that cannot be printed");
            std::string name;
            for (const std::string& each : scopes_) name += each + ".";
            name += body[3];
            for (const char character : name)
                if (!std::isalnum(static_cast<unsigned char>(character)) && character != '_' &&
                    character != '.')
                    return fail("'" + name + "' is no identifier");
            if (!wires_.emplace(body[2], Wire{name}).second) return fail("a code that is given twice");
            if (!pulses_.emplace(name, std::vector<Pulse>{}).second)
                return fail("two wires are named " + name);
        } else if (keyword == "$timescale") {
            for (const std::string& each : body) timescale_ += each;
        } else if (keyword == "$enddefinitions") {
            if (!scopes_.empty()) return fail("a scope is still open");
            defined_ = true;
        } else if (keyword != "$comment" && keyword != "$version" && keyword != "$date") {
            fail("keyword " + keyword);
        }
    }
    void change(const std::string& word) {
        const auto found = wires_.find(word.substr(1));
        if (found == wires_.end()) return fail("a change of what is not declared: " + word);
        Wire& wire = found->second;
        const bool up = word[0] == '1';
        if (wire.has_value && up == wire.is_up) return fail(wire.name + " changes to what it is");
        if (wire.has_value && !up) pulses_[wire.name].push_back({wire.since, time_});
        wire = {wire.name, up, true, time_};
    }
    void read() {
        std::string word;
        bool has_time = false;
        while (fault_.empty() && words_ >> word) {
            if (word[0] == '#') {
                const std::int64_t time = std::stoll(word.substr(1));
                if (!defined_ || (has_time && time <= time_)) return fail("time goes back at " + word);
                time_ = time;
                has_time = true;
            } else if (word == "$dumpvars" || word == "$end") {
                if (!has_time) fail("values before the first time");
            } else if (word[0] == '$') {
                if (defined_) return fail("a declaration after the definitions");
                declare(word);
            } else if (word[0] == '0' || word[0] == '1') {
                change(word);
            } else {
                fail("'" + word + "'");
            }
        }
        for (const auto& [code, wire] : wires_)
            if (!wire.has_value)
                fail(wire.name + " has no value");
            else if (wire.is_up)
                fail(wire.name + " never falls");
    }

    std::istringstream words_;
    std::string fault_{};
    std::string timescale_{};
    std::vector<std::string> scopes_{};
    std::map<std::string, Wire> wires_{};
    std::map<std::string, std::vector<Pulse>> pulses_{};
    std::int64_t time_ = 0;
    bool defined_ = false;
};

} // namespace tappet::browser
