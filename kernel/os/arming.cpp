// The report of arming: the findings, which of them refuse, and its text for a person.
#include "kernel/os/arming.hpp"

#include "kernel/base/nearest.hpp"
#include "kernel/os/terminal.hpp"

#include <algorithm>

namespace tappet::os {

namespace {

Sentence counted(std::size_t n, std::string_view one) noexcept {
    return Sentence{n, " ", one, n == 1 ? "" : "s"};
}

} // namespace

void ArmingReport::add(const Finding& finding) noexcept {
    if (!findings_.push(finding)) ++lost_;
}

void ArmingReport::passed(std::string_view name, const Sentence& finding) noexcept {
    add({name, Severity::passed, finding, {}});
}

void ArmingReport::fault(std::string_view name, const Sentence& finding, const Sentence& cure) noexcept {
    const bool only_warns = std::find(downgraded_.begin(), downgraded_.end(), name) != downgraded_.end();
    add({name, only_warns ? Severity::warning : Severity::refused, finding, cure});
}

void ArmingReport::refuse(std::string_view name, const Sentence& finding, const Sentence& cure) noexcept {
    add({name, Severity::refused, finding, cure});
}

void ArmingReport::warning(std::string_view name, const Sentence& finding, const Sentence& cure) noexcept {
    add({name, Severity::warning, finding, cure});
}

bool ArmingReport::conclude() noexcept {
    const std::size_t checks = findings_.size();
    for (const std::string_view name : downgraded_) {
        if (has_check(name)) continue;
        Nearest nearest{name};
        for (std::size_t i = 0; i < checks; ++i) nearest.consider(findings_[i].name);
        Sentence cure{"correct the name in the board's list of downgraded checks"};
        if (!nearest.best().empty()) cure.add("; did you mean \"").add(nearest.best()).add("\"?");
        add({"downgraded-checks", Severity::refused, Sentence{"no check is called \"", name, "\""}, cure});
    }
    concluded_ = true;
    return can_arm();
}

std::size_t ArmingReport::count(Severity severity) const noexcept {
    return static_cast<std::size_t>(std::count_if(
        findings_.begin(), findings_.end(), [severity](const Finding& f) { return f.severity == severity; }));
}

bool ArmingReport::has_check(std::string_view name) const noexcept {
    return std::any_of(findings_.begin(), findings_.end(),
                       [name](const Finding& f) { return f.name == name; });
}

void print(const ArmingReport& report, int file) noexcept {
    // When nobody reads the file, the machine's answer does not depend on it.
    const auto say = [file](const Sentence& text) { static_cast<void>(write_all(file, text.view())); };
    Sentence head;
    if (report.refused() > 0)
        head.add("cannot arm: ").add(counted(report.refused(), "reason"));
    else
        head.add("can arm: ").add(counted(report.findings().size(), "check")).add(" made");
    if (report.warnings() > 0) head.add(", ").add(counted(report.warnings(), "warning"));
    say(head.add("\n"));
    for (const Severity severity : {Severity::refused, Severity::warning})
        for (const Finding& found : report.findings()) {
            if (found.severity != severity) continue;
            say(Sentence{severity == Severity::refused ? "  refused  " : "  warning  ", found.name, ": ",
                         found.finding});
            say(Sentence{"; cure: ", found.cure, "\n"});
        }
    if (report.lost() > 0)
        say(Sentence{"  refused  ", counted(report.lost(), "finding"),
                     " had no room here; cure: raise ArmingReport::max_findings\n"});
}

} // namespace tappet::os
