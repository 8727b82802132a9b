#!/bin/sh
# Stands for `footfall run SCENARIO --seed N ... --log DIR`: does what the scenario's `doc` says, without a robot.
# `doc` holds words with seeds: "crash@2 fail@3,4 hang@5 garbage@6 pass"; a word without seeds means all.
[ "$1" = run ] || exit 0  # a report that nobody reads
path=$2
while [ $# -gt 0 ]; do
  case $1 in
    --seed) seed=$2 ;;
    --log) folder=$2 ;;
  esac
  shift
done
act=pass seen='' passed=true end=time code=0
first='"passed": true'
while IFS= read -r line; do
  case $line in
    doc:*)
      line=${line#doc: \"}
      for word in ${line%\"}; do
        case ",${word#*@}," in
          "$word" | *",$seed,"* | ",$word,") act=${word%@*} ;;
        esac
      done ;;
    "  - "*) seen="$seen|" ;;
  esac
done <"$path"
mkdir -p "${folder%/*}"
[ "$act" != late ] || sleep 0.3
mkdir "$folder" && echo "a log" >"$folder/log.mcap" || exit 3
case $act in
  crash) printf 'about to crash \001\377 <&>\n' >&2; kill -SEGV $$ ;;
  hang) exec sleep 60 ;;
  garbage) echo '{"passed": tr'; exit 0 ;;
  silence) exit 0 ;;
  input) echo "s.yaml:3:1: error: it is wrong" >&2; exit 2 ;;
  machine) exit 3 ;;
  fall) passed=false end=fall code=1 ;;
  slow) sleep 0.4 ;;
  fail)
    passed=false code=1
    first='"passed": false, "value": "0.25 rad", "at_s": 1.5, "tick": 1500, "state": "a", "why": "it was too much"' ;;
esac
list='' item=$first
while [ -n "$seen" ]; do
  list="$list${list:+, }{$item}" item='"passed": true' seen=${seen#?}
done
printf 'time,state,com.pos.z\n0.0,a,0.0\n0.5,a,%s\n' "$act" | sed 's/pass/0.5/; s/fail/0.5/; s/slow/0.7/' >"$folder/golden.csv"
echo "chatter before the result"
cat <<END
{"seed": $seed, "passed": $passed, "expectations": [$list], "end": "$end", "coverage": {"states": ["machine", "a"], "transitions": [{"index": 0, "taken": $([ $((seed % 2)) = 1 ] && echo true || echo false)}], "guards": [{"index": 1, "true": false, "false": true}]}}
END
exit $code
