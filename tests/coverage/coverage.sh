#!/usr/bin/env bash
# Promises: COVERAGE.
#
# Counts the lines and branches of protocol/wire and firmware_sim/core that their own tests come by, and fails where one
# is left out. What the compiler adds for exceptions, of which that code has none, does not count; nor do the branches of
# comparisons that it writes itself (= default), of keeps(Rule), which is constant but in the model checker's build, and
# of what a field's row says of it, which is constant in each instantiation.
#
# usage: coverage.sh    (./dev coverage; builds into build/coverage)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

folder=build/coverage
programs=(wire_test core_test fault_test)
constant='.*(= default;|keeps\(Rule::|detail::row\(|FieldRule\(field\)|field\.(values|all_ones|length)).*'
[[ -f $folder/build.ninja ]] || cmake --preset coverage >&2
cmake --build "$folder" -j "${PINJAW_JOBS:-$(nproc)}" --target "${programs[@]}" >&2
find "$folder" -name '*.gcda' -delete
for program in "${programs[@]}"; do
  env -u PINJAW_FIGURES "$folder/bin/$program" --gtest_brief=1 >&2
done
status=0
gcovr --root . --filter protocol/wire/ --filter firmware_sim/core/ --txt "$folder/lines.txt" --sort-uncovered \
  --print-summary --fail-under-line 100 "$folder" | grep '^lines:' >"$folder/summary.txt" || status=$?
tests/coverage/branches.py "$folder" --leave-out "$constant" protocol/wire firmware_sim/core >>"$folder/summary.txt" || status=$?
cat "$folder/lines.txt" "$folder/summary.txt"
if [[ -n ${PINJAW_FIGURES:-} ]]; then
  sed -nE 's/^(lines|branches): ([0-9.]+)% .*/{"promise": "COVERAGE", "what": "\1", "value": "\2", "unit": "%"}/p' \
    "$folder/summary.txt" >>"$PINJAW_FIGURES"
fi
exit "$status"
