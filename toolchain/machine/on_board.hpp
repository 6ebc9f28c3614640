// The parts of a program for a board, as named by tappet_machine() of CMake: a table, a board, and the
// binding between them. Only the mains for boards include it, first.
#pragma once

#include TAPPET_TABLE_HEADER
#include TAPPET_BOARD_HEADER
#ifdef TAPPET_BINDINGS_HEADER
#include TAPPET_BINDINGS_HEADER
#define TAPPET_BINDING TAPPET_NAMESPACE::bindings::TAPPET_BOARD
#else
#define TAPPET_BINDING tappet::unbound
#endif

#include "kernel/machine/firmware.hpp"
#include "toolchain/machine/code.hpp"

namespace TAPPET_NAMESPACE {

using OnBoard = tappet::Firmware<table, tappet::board::TAPPET_BOARD, TAPPET_BINDING>;

} // namespace TAPPET_NAMESPACE
