# SPDX-License-Identifier: Apache-2.0
# bash asks the front door itself what may stand in a place: its table is the only one.
_tappet() {
    mapfile -t COMPREPLY < <("$1" --complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
}
complete -o bashdefault -o default -F _tappet tappet
