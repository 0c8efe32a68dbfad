// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the job script. Slurm signals the script, and not greatx, before the time limit (--signal=B:USR1), so
// that it knows the limit from a cancellation, which sends SIGTERM to both.
#include "apps/campaign/slurm_script.h"

#include "core/error.h"

namespace greatx::apps {
namespace {

constexpr std::string_view script_text = R"script(#!/usr/bin/env bash
@HEADER@#
# The campaign @NAME@ on Slurm, as `greatx campaign slurm` wrote it (docs/campaigns.md, "On a cluster"):
#   bash job.sh          submits the tasks, and a job that merges and verifies once all of them are done
#   sbatch job.sh        submits the tasks alone
#   bash job.sh merge    merges and verifies here
# Each may be repeated: what is complete stays, and the rest goes on.
set -euo pipefail

greatx=@GREATX@
campaign=@CAMPAIGN@
logs=@LOGS@
tasks=@TASKS@
restarts=@RESTARTS@
common=(@COMMON@)
run=(@RUN@)
merge_job=(@MERGE@)

setup() {
  set +u # what a site provides may use variables that are not set
@SETUP@  set -u
  export LP_NUM_THREADS="${LP_NUM_THREADS:-@THREADS@}" # of lavapipe; drivers of graphics cards do not read it
}

say() { # a full disk is no reason to end
  echo "job: $*" >&2 || true
}

submit() {
  local script array merge
  script=$(realpath -- "${BASH_SOURCE[0]}")
  mkdir -p -- "$logs" # Slurm does not make it, and ends jobs without a word if it is missing
  array=$(sbatch --parsable "$script")
  array=${array%%;*} # the name of a cluster may follow
  merge=$(
    printf '#!/usr/bin/env bash\nexec bash %q merge\n' "$script" |
      sbatch --parsable "${merge_job[@]}" --dependency="afterok:$array" --kill-on-invalid-dep=yes
  )
  echo "submitted $tasks tasks as job $array, and their merge as job ${merge%%;*}"
}

merge() {
  setup
  "$greatx" campaign merge "$campaign" "${common[@]}"
  "$greatx" campaign verify "$campaign" "${common[@]}"
}

child='' signals=0 limit='' cancelled=''
on_limit() { # the time limit is near: greatx ends after its tick, and the task goes on in its next run
  limit=1 signals=$((signals + 1))
  [ -z "$child" ] || kill -TERM "$child" 2>/dev/null || true
}
on_cancel() { # Slurm has sent the same to greatx
  cancelled=1 signals=$((signals + 1))
}

wait_for_child() { # returns the child's exit code; signals that arrive meanwhile do not end it
  local before code
  while true; do
    before=$signals code=0
    wait "$child" || code=$?
    [ "$before" != "$signals" ] || return "$code"
  done
}

requeue() { # requeue REASON
  if [ "${SLURM_RESTART_COUNT:-0}" -ge "$restarts" ]; then
    say "$1; it has been restarted $restarts times and is not again; submit the script again to go on"
    return
  fi
  say "$1; it goes on in its next run"
  scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID" || say "scontrol has failed"
}

task() {
  local code=0 restart=${SLURM_RESTART_COUNT:-0}
  trap on_limit USR1
  trap on_cancel TERM
  say "task $SLURM_ARRAY_TASK_ID of $tasks, restart $restart, on ${SLURMD_NODENAME:-this node}"
  setup
  "$greatx" campaign run "$campaign" "${common[@]}" --shard "$SLURM_ARRAY_TASK_ID/$tasks" "${run[@]}" &
  child=$!
  [ -z "$limit" ] || kill -TERM "$child" 2>/dev/null || true # the signal came before
  wait_for_child || code=$?
  if [ -n "$cancelled" ]; then
    say "the task was stopped"
  elif [ -n "$limit" ] && { [ "$code" = 130 ] || [ "$code" = 143 ]; }; then
    requeue "the time limit of the task is near"
  elif [ "$code" = 137 ]; then
    requeue "greatx was killed, by somebody or for its memory"
  elif [ "$code" != 0 ]; then
    say "greatx has failed with exit code $code, and the merge is cancelled; submit the script again to go on"
  fi
  exit "$code"
}

case "${1:-}" in
  merge) merge ;;
  '') if [ -n "${SLURM_ARRAY_TASK_ID:-}" ]; then task; else submit; fi ;;
  *) echo "job: expected nothing or 'merge', found '$1'" >&2; exit 1 ;;
esac
)script";

}  // namespace

std::string filled_slurm_script(const std::map<std::string_view, std::string>& values) {
  std::string script;
  size_t at = 0;
  while (at < script_text.size()) {
    const size_t begin = script_text.find('@', at);
    script += script_text.substr(at, begin - at);
    if (begin == std::string_view::npos) break;
    const size_t end = script_text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ", begin + 1);
    const std::string_view name = script_text.substr(begin + 1, end - begin - 1);
    if (name.empty() || script_text[end] != '@') {  // the @ of bash
      script += '@';
      at = begin + 1;
      continue;
    }
    const auto value = values.find(name);
    GREATX_CHECK(value != values.end(), "{} has no value", name);
    script += value->second;
    at = end + 1;
  }
  return script;
}

}  // namespace greatx::apps
