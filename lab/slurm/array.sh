#!/bin/bash
# Submits a sweep to Slurm: one array job whose tasks are shards, then one job that joins their results.
# Made from a template (lab/slurm/array.sh of Footfall, or --template FILE); edit it for your cluster, or edit the
# template and make it anew. Every task may be killed, requeued or submitted again: runs that are done are not repeated.
# Usage: bash {{script}} [options of sbatch for both jobs, e.g. --partition=long --time=4:00:00]
set -euo pipefail
cd {{folder}}

array=$(sbatch --parsable "$@" <<'ARRAY'
#!/bin/bash
#SBATCH --job-name={{name}}
#SBATCH --array=1-{{shards}}
#SBATCH --cpus-per-task={{jobs}}
#SBATCH --requeue
#SBATCH --output={{out}}/slurm-%A_%a.log
exec {{command}} --shard "$SLURM_ARRAY_TASK_ID/{{shards}}" --jobs "${SLURM_CPUS_PER_TASK:-{{jobs}}}"
ARRAY
)
echo "shards: job $array"

merge=$(sbatch --parsable "$@" --dependency="afterany:$array" <<'MERGE'
#!/bin/bash
#SBATCH --job-name={{name}}-merge
#SBATCH --output={{out}}/slurm-merge-%j.log
exec {{merge}}
MERGE
)
echo "merge:  job $merge"
