// The rows of a machine table as plain data, and the words that spell them. Nothing here is checked:
// kernel/machine/check.hpp reads the finished table.
#pragma once

#include "kernel/machine/rows_activities.hpp"
#include "kernel/machine/rows_behaviours.hpp"
#include "kernel/machine/rows_components.hpp"
#include "kernel/machine/rows_connections.hpp"
#include "kernel/machine/rows_reactions.hpp"
