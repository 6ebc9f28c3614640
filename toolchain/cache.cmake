# SPDX-License-Identifier: Apache-2.0
# Where ci/setup has put what no Debian package offers ready-made; the same rule as in ci/setup.
include_guard(GLOBAL)

if(DEFINED ENV{TAPPET_CACHE})
    set(tappet_cache_default "$ENV{TAPPET_CACHE}")
elseif(DEFINED ENV{XDG_CACHE_HOME})
    set(tappet_cache_default "$ENV{XDG_CACHE_HOME}/tappet")
elseif(DEFINED ENV{HOME})
    set(tappet_cache_default "$ENV{HOME}/.cache/tappet")
else()
    set(tappet_cache_default "/root/.cache/tappet")
endif()
set(TAPPET_CACHE "${tappet_cache_default}" CACHE PATH "What ci/setup fetched and built")
