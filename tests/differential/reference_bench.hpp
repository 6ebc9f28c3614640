// The components of bench.hpp as the second interpreter acts on them: by name, through an instance of its
// own.
#pragma once

#include "tests/differential/bench.hpp"
#include "tests/differential/reference_program.hpp"

#include <deque>
#include <functional>

namespace tappet::reference {

class BenchWorld final : public World {
public:
    Diary diary{};
    Bench own{};
    Bench mate{};
    Arm arm{};
    double measured = 0; ///< value at the input
    double setpoint = 0;
    static constexpr std::size_t places = 4; ///< of a buffer
    std::deque<std::int64_t> queue{};
    std::deque<double> sent{};
    /// Called for each emitted event, after the diary.
    std::function<void(const std::string& event, const std::vector<Value>& arguments)> heard;
    /// The script's program "aid", which other programs of it command.
    struct Beside {
        virtual bool begin(const std::vector<Value>& given) = 0;
        virtual Answer ended() = 0;
        virtual void stop() = 0;
        [[nodiscard]] virtual bool is_running() const = 0;
        [[nodiscard]] virtual Value result() const = 0;

    protected:
        ~Beside() = default;
    };
    Beside* aid = nullptr;

    BenchWorld() {
        own.diary = mate.diary = &diary;
        own.name = "own";
        mate.name = "mate";
        arm.diary = &diary;
    }
    /// Steps the other activity: sent commands begin, running ones continue.
    void step_arm() {
        while (!sent_.empty()) {
            Sent& each = *sent_.front();
            sent_.pop_front();
            const bool accepted = each.name == "arm.move"
                                      ? arm.move(std::get<std::int64_t>(each.arguments[0]))
                                      : arm.grip(real(each.arguments[0]), std::get<bool>(each.arguments[1]));
            each.state = accepted ? Sent::at_work : Sent::failed;
            if (accepted) followed_.push_back(&each);
        }
        std::erase_if(followed_, [this](Sent* each) {
            const CommandProgress progress =
                each->name == "arm.move" ? arm.job.progress() : CommandProgress::done;
            if (progress == CommandProgress::executing) return false;
            each->state = progress == CommandProgress::done ? Sent::done : Sent::failed;
            return true;
        });
    }

    [[nodiscard]] Kind kind_of(const std::string& name) const override {
        if (name == "work" || name == "aid") return Kind::command;
        if (name.starts_with("aid.")) return Kind::method;
        if (name == "arm.move" || name == "arm.grip") return Kind::sent_command;
        const std::string last = name.substr(name.rfind('.') + 1);
        if (last == "tick" || last == "moved" || last == "switched") return Kind::event;
        return last == "note" || last == "mix" || last == "ask" || last == "poke" || last == "sum" ||
                       last == "shift" || last == "say" || last == "pop" || last == "push"
                   ? Kind::method
                   : Kind::value;
    }
    std::optional<Value> read(const std::string& name) override {
        if (name == result_of_program) {
            count("result of a program");
            return aid->result();
        }
        const Bench& of = name.starts_with("mate.") ? mate : own;
        const std::string last = name.substr(name.rfind('.') + 1);
        if (last == "gain") return Value{std::int64_t{of.gain.get()}};
        if (last == "level") return Value{of.level.get()};
        if (last == "open") return Value{of.open.get()};
        if (last == "measured") return Value{measured};
        if (last == "setpoint") return Value{setpoint};
        if (name == "queue.empty") return Value{queue.empty()};
        return std::nullopt;
    }
    bool write(const std::string& name, const Value& value) override {
        Bench& of = name.starts_with("mate.") ? mate : own;
        const std::string last = name.substr(name.rfind('.') + 1);
        if (last == "gain") {
            const std::int64_t number = std::get<std::int64_t>(value);
            if (number < -50 || number > 50) return false;
            of.gain.set(static_cast<std::int32_t>(number));
        } else if (last == "level") {
            if (!(real(value) >= -1000 && real(value) <= 1000)) return false;
            of.level.set(real(value));
        } else if (last == "open") {
            of.open.set(std::get<bool>(value));
        } else if (last == "setpoint") {
            setpoint = real(value);
        } else {
            return false;
        }
        return true;
    }
    std::optional<Value> call(const std::string& name, const std::vector<Value>& given) override {
        if (name == "aid.isRunning") return Value{aid->is_running()};
        if (name == "aid.stop") {
            count("program stopped");
            aid->stop();
            return Value{};
        }
        Bench& of = name.starts_with("mate.") ? mate : own;
        const std::string last = name.substr(name.rfind('.') + 1);
        const auto whole = [&](std::size_t i, std::int64_t bound) -> std::optional<std::int64_t> {
            const std::int64_t number = std::get<std::int64_t>(given[i]);
            if (number < -bound || number >= bound) return std::nullopt;
            return number;
        };
        if (last == "note") return Value{of.note(std::get<std::int64_t>(given[0]))};
        if (last == "mix") {
            const auto b = whole(1, std::int64_t{1} << 31);
            if (!b) return std::nullopt;
            return Value{of.mix(real(given[0]), static_cast<std::int32_t>(*b))};
        }
        if (last == "ask") {
            const auto n = whole(0, 1 << 15);
            if (!n) return std::nullopt;
            return Value{of.ask(static_cast<std::int16_t>(*n))};
        }
        if (last == "shift") {
            const Record& from = std::get<Record>(given[0]);
            const Place place = of.shift({from.x, static_cast<std::int32_t>(from.turns)}, real(given[1]));
            return Value{Record{place.x, place.turns}};
        }
        if (last == "say") {
            Text<8> text;
            if (!text.assign(std::get<std::string>(given[0]))) return std::nullopt;
            return Value{of.say(text)};
        }
        if (last == "pop") {
            if (queue.empty()) return std::nullopt;
            const std::int64_t number = queue.front();
            queue.pop_front();
            return Value{number};
        }
        if (last == "push") {
            if (sent.size() == places) return std::nullopt;
            sent.push_back(real(given[0]));
            return Value{};
        }
        if (last == "poke") {
            of.poke(std::get<bool>(given[0]));
            return Value{};
        }
        if (last == "sum") {
            const auto b = whole(1, std::int64_t{1} << 31);
            if (!b) return std::nullopt;
            return Value{arm.sum(std::get<std::int64_t>(given[0]), static_cast<std::int32_t>(*b))};
        }
        if (last == "moved" && !whole(0, std::int64_t{1} << 31)) return std::nullopt;
        emit(name, given);
        return Value{};
    }
    void emit(const std::string& name, std::vector<Value> given) {
        if (name.ends_with("moved")) given[1] = real(given[1]);
        std::string line = "event " + name;
        for (const Value& each : given) line += " " + print(each);
        diary.write(line);
        if (heard) heard(name, given);
    }
    bool begin(const std::string& name, const std::vector<Value>& given) override {
        if (name == "aid") {
            const bool begun = aid->begin(given);
            count(begun ? "program commanded" : "program rejected");
            return begun;
        }
        return own.work(std::get<std::int64_t>(given[0]));
    }
    Answer progress(const std::string& name, const std::vector<Value>&) override {
        if (name == "aid") return aid->ended();
        switch (own.worked(0)) {
        case CommandProgress::executing: return Answer::no;
        case CommandProgress::done: return Answer::yes;
        case CommandProgress::failed: return Answer::failed;
        }
        return Answer::failed;
    }
    bool send(const std::string& name, const std::vector<Value>& given) override {
        Sent& slot = slots_[name];
        if (slot.state == Sent::sent || slot.state == Sent::at_work) return false;
        slot = {name.substr(name.rfind('|') + 1), given, Sent::sent};
        sent_.push_back(&slot);
        return true;
    }
    Answer ended(const std::string& name) override {
        const Sent& slot = slots_[name];
        return slot.state == Sent::done     ? Answer::yes
               : slot.state == Sent::failed ? Answer::failed
                                            : Answer::no;
    }

private:
    struct Sent {
        std::string name{};
        std::vector<Value> arguments{};
        enum { ready, sent, at_work, done, failed } state = ready;
    };
    static double real(const Value& value) {
        if (const auto* number = std::get_if<std::int64_t>(&value)) return static_cast<double>(*number);
        return std::get<double>(value);
    }

    std::map<std::string, Sent> slots_;
    std::deque<Sent*> sent_;
    std::vector<Sent*> followed_;
};

} // namespace tappet::reference
