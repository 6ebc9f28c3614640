// The words of a script, for the second reader of it.
#pragma once

#include "tests/differential/reference_syntax.hpp"

#include <cctype>
#include <cstdlib>
#include <utility>

namespace tappet::reference {

struct Word {
    enum class Kind : std::uint8_t { name, number, real, span, text, sign, end };
    Kind kind = Kind::end;
    std::string text{};
    Value value{};
    int line = 0;
};

inline std::int64_t unit_of(std::string_view unit) {
    constexpr std::pair<std::string_view, std::int64_t> units[] = {
        {"ns", 1},         {"us", 1000},         {"ms", 1000000},
        {"s", 1000000000}, {"min", 60000000000}, {"h", 3600000000000}};
    for (const auto& [name, ns] : units)
        if (name == unit) return ns;
    return 0;
}

class Words {
public:
    explicit Words(std::string_view text) : text_{text} {}

    std::vector<Word> all() {
        std::vector<Word> words;
        do words.push_back(next());
        while (words.back().kind != Word::Kind::end);
        return words;
    }

private:
    [[nodiscard]] char here(std::size_t ahead = 0) const {
        return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
    }
    void skip() {
        for (;;) {
            if (here() == '#' || (here() == '/' && here(1) == '/')) {
                while (here() != '\n' && here() != '\0') ++at_;
            } else if (here() == '/' && here(1) == '*') {
                for (at_ += 2; here() != '\0' && !(here() == '*' && here(1) == '/'); ++at_)
                    if (here() == '\n') ++line_;
                at_ += 2;
            } else if (std::isspace(static_cast<unsigned char>(here())) != 0) {
                if (here() == '\n') ++line_;
                ++at_;
            } else {
                return;
            }
        }
    }
    Word next() {
        skip();
        Word word{.line = line_};
        const std::size_t from = at_;
        const auto is_letter = [](char c) {
            return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
        };
        if (here() == '\0') return word;
        if (std::isdigit(static_cast<unsigned char>(here())) != 0) {
            number(word);
        } else if (is_letter(here())) {
            while (is_letter(here())) ++at_;
            word.kind = Word::Kind::name;
            word.text = text_.substr(from, at_ - from);
        } else if (here() == '"') {
            ++at_;
            while (here() != '"' && here() != '\0') ++at_;
            word.kind = Word::Kind::text;
            word.text = text_.substr(from + 1, at_ - from - 1);
            word.value = word.text;
            ++at_;
        } else {
            const std::string_view two = text_.substr(at_, 2);
            const bool is_two =
                two == "==" || two == "!=" || two == "<=" || two == ">=" || two == "&&" || two == "||";
            word.kind = Word::Kind::sign;
            word.text = text_.substr(at_, is_two ? 2 : 1);
            at_ += word.text.size();
        }
        return word;
    }
    void number(Word& word) {
        const std::size_t from = at_;
        bool is_real = false;
        while (std::isdigit(static_cast<unsigned char>(here())) != 0) ++at_;
        if (here() == '.' && std::isdigit(static_cast<unsigned char>(here(1))) != 0) {
            is_real = true;
            ++at_;
            while (std::isdigit(static_cast<unsigned char>(here())) != 0) ++at_;
        }
        if ((here() == 'e' || here() == 'E') &&
            (std::isdigit(static_cast<unsigned char>(here(1))) != 0 || here(1) == '-' || here(1) == '+')) {
            is_real = true;
            at_ += 2;
            while (std::isdigit(static_cast<unsigned char>(here())) != 0) ++at_;
        }
        word.text = text_.substr(from, at_ - from);
        const std::size_t digits_end = at_;
        while (std::isalpha(static_cast<unsigned char>(here())) != 0) ++at_;
        const std::int64_t unit = unit_of(text_.substr(digits_end, at_ - digits_end));
        if (unit != 0) {
            word.kind = Word::Kind::span;
            word.value = Span{is_real ? static_cast<std::int64_t>(std::strtod(word.text.c_str(), nullptr) *
                                                                  static_cast<double>(unit))
                                      : std::strtoll(word.text.c_str(), nullptr, 10) * unit};
            return;
        }
        at_ = digits_end;
        word.kind = is_real ? Word::Kind::real : Word::Kind::number;
        if (is_real)
            word.value = std::strtod(word.text.c_str(), nullptr);
        else
            word.value = static_cast<std::int64_t>(std::strtoll(word.text.c_str(), nullptr, 10));
    }

    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 1;
};
} // namespace tappet::reference
