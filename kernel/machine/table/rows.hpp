// The rows of a machine table as plain data, and the functions that spell them. Nothing here is checked:
// kernel/machine/check/check.hpp checks the finished table.
#pragma once

#include "kernel/machine/table/activities.hpp"
#include "kernel/machine/table/behaviours.hpp"
#include "kernel/machine/table/components.hpp"
#include "kernel/machine/table/connections.hpp"
#include "kernel/machine/table/reactions.hpp"
