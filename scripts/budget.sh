# SPDX-License-Identifier: AGPL-3.0-or-later
# To be sourced. timed STEP COMMAND... runs the command and adds "SECONDS STEP" to the file $PALPATE_BUDGET;
# show_budget prints that file as a table. Both leave the exit status of the command alone.
timed() {
  local step=$1 start=$SECONDS code=0
  shift
  "$@" || code=$?
  printf '%6d %s\n' $((SECONDS - start)) "$step" >>"$PALPATE_BUDGET"
  return "$code"
}

show_budget() {
  echo
  echo "== seconds of each step"
  awk '{ print; total += $1 } END { printf "%6d total (%d min %02d s)\n", total, total / 60, total % 60 }' "$PALPATE_BUDGET"
}
