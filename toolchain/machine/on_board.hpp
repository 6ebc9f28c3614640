// What a program for a board is made of, as tappet_machine() of CMake named it: a table, a board, and the
// binding between them. Included first by the mains for boards, and by nobody else.
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
