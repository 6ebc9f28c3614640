// The status of a program and its transitions, as listed in the header's table.
#include "kernel/program/execution.hpp"

#include <algorithm>
#include <cstring>

namespace tappet {

void ProgramExecution::bind(const ProgramCode& code, const ProgramContext& context,
                            std::span<const std::byte> image, const ProgramPolicy& policy,
                            ProgramIndex program) noexcept TAPPET_REALTIME {
    code_ = code;
    context_ = context;
    image_ = image;
    policy_ = policy;
    program_ = program;
    failures_ = 0;
    fill(0);
    status_ = ProgramStatus::stopped;
    static_cast<void>(reset());
}

// Resets the data from that offset on: from the image, and zero beyond it.
void ProgramExecution::fill(std::size_t from) noexcept TAPPET_REALTIME {
    const std::size_t size = code_.tables->layout.size;
    const std::size_t given = std::clamp<std::size_t>(image_.size(), from, size);
    if (given != from) std::memcpy(context_.data + from, image_.data() + from, given - from);
    if (size != given) std::memset(context_.data + given, 0, size - given);
}

bool ProgramExecution::reset() noexcept TAPPET_REALTIME {
    if (is_at_work()) return false;
    // The parameters precede all other variables.
    std::size_t end = code_.tables->layout.constants;
    for (const VariableRow& row : code_.tables->variables)
        if (row.kind == VariableKind::parameter) end = std::size_t{row.at} + row.type->size;
    fill(end);
    context_.position = {};
    left_over_ = waits_ = has_ended_ = false;
    status_ = ProgramStatus::ready;
    return true;
}

bool ProgramExecution::start() noexcept TAPPET_REALTIME {
    switch (status_) {
    case ProgramStatus::ready:
    case ProgramStatus::stopped:
        has_ended_ = false;
        context_.position = {.node = code_.tables->programs[program_].first};
        waits_ = false;
        break;
    case ProgramStatus::paused: break;
    case ProgramStatus::running:
    case ProgramStatus::error: return false;
    }
    status_ = ProgramStatus::running;
    return true;
}

void ProgramExecution::give(const std::byte* parameters) noexcept TAPPET_REALTIME {
    for (const VariableRow& row : code_.tables->variables) {
        if (row.kind != VariableKind::parameter) continue;
        std::memcpy(context_.data + row.at, parameters, row.type->size);
        parameters += row.type->size;
    }
}

void ProgramExecution::take_result(std::byte* into) const noexcept TAPPET_REALTIME {
    for (const VariableRow& row : code_.tables->variables)
        if (row.kind == VariableKind::result) std::memcpy(into, context_.data + row.at, row.type->size);
}

bool ProgramExecution::pause() noexcept TAPPET_REALTIME {
    if (status_ != ProgramStatus::running) return false;
    if (comes_later(ProgramStatus::paused)) return true;
    status_ = ProgramStatus::paused;
    left_over_ = false;
    return true;
}

bool ProgramExecution::stop() noexcept TAPPET_REALTIME {
    if (status_ == ProgramStatus::ready || status_ == ProgramStatus::stopped) return false;
    if (comes_later(ProgramStatus::stopped)) return true;
    status_ = ProgramStatus::stopped;
    context_.position = {};
    left_over_ = waits_ = false;
    return true;
}

void ProgramExecution::step(Time now) noexcept TAPPET_REALTIME {
    if (status_ == ProgramStatus::running) run(now, policy_.statements);
}

bool ProgramExecution::single_step(Time now) noexcept TAPPET_REALTIME {
    if (status_ != ProgramStatus::paused) return false;
    run(now, 1);
    left_over_ = false;
    return true;
}

bool ProgramExecution::comes_later(ProgramStatus wanted) noexcept TAPPET_REALTIME {
    if (is_in_step_ && wanted_ != ProgramStatus::stopped) wanted_ = wanted;
    return is_in_step_;
}

void ProgramExecution::run(Time now, std::uint32_t statements) noexcept TAPPET_REALTIME {
    context_.now = now;
    is_in_step_ = true;
    wanted_ = ProgramStatus::running;
    advance(statements);
    is_in_step_ = false;
    if (wanted_ == ProgramStatus::stopped && is_at_work()) static_cast<void>(stop());
    if (wanted_ == ProgramStatus::paused) static_cast<void>(pause());
}

void ProgramExecution::advance(std::uint32_t statements) noexcept TAPPET_REALTIME {
    left_over_ = waits_ = false;
    // A turn after a failure begins with a statement, so that there are no more turns than statements.
    for (std::uint32_t turn = 0, turns = statements; turn <= turns; ++turn) {
        switch (code_.run(*code_.tables, context_, statements)) {
        case ProgramReturn::ended:
            status_ = ProgramStatus::stopped;
            has_ended_ = true;
            return;
        case ProgramReturn::waits: waits_ = true; return;
        case ProgramReturn::left_over: left_over_ = true; return;
        case ProgramReturn::failed: break;
        }
        ++failures_;
        if (!policy_.continue_on_error) {
            status_ = ProgramStatus::error;
            return;
        }
        context_.position = {.node = past_failure(*code_.tables, context_.position.node)};
    }
    left_over_ = true;
}

Time ProgramExecution::wakes() const noexcept TAPPET_REALTIME {
    if (status_ != ProgramStatus::running) return never;
    return waits_ ? code_.wakes(*code_.tables, context_) : context_.now;
}

} // namespace tappet
