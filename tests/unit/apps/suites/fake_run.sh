#!/bin/sh
# Stands for `footfall run BEHAVIOR --seed N --set k=v ...` as a child of a sweep. $FAKE_ACTS holds words with seeds,
# "crash@2 hang@5"; a seed without a word passes. $FAKE_LOG gets a line for each start.
command=$*
while [ $# -gt 0 ]; do
  [ "$1" = --seed ] && seed=$2
  shift
done
echo "$command" >>"$FAKE_LOG"
act=pass
for word in $FAKE_ACTS; do
  [ "${word#*@}" = "$seed" ] && act=${word%@*}
done
end=time code=0
case $act in
  crash) echo "about to crash" >&2; kill -SEGV $$ ;;
  hang) exec sleep 60 ;;
  garbage) echo '{"end": '; exit 0 ;;
  input) echo "b.yaml:3:1: error: it is wrong" >&2; exit 2 ;;
  machine) exit 3 ;;
  fall) end=fall code=1 ;;
  slow) sleep 0.3 ;;
esac
echo "{\"end\": \"$end\", \"steps\": $seed, \"error\": {\"pitch\": {\"max\": 0.0$seed}}, \"time_s\": 1.5}"
exit $code
