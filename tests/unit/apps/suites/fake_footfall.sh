#!/bin/sh
# Stands for `footfall run SCENARIO --seed N ... --log DIR`: does what the scenario's `doc` says, without a robot.
# `doc` holds words with seeds: "crash@2 fail@3,4 hang@5 garbage@6 pass"; a word without seeds means all.
if [ "$1" = report ]; then  # report FOLDER --output PAGE --from=A --to=B
  echo "$5 $6" >"$4"
  exit 0
fi
path=$2
while [ $# -gt 0 ]; do
  case $1 in
    --seed) seed=$2 ;;
    --log) folder=$2 ;;
  esac
  shift
done
act=pass seen='' passed=true end=time code=0 failures=''
first='"passed": true' second='"passed": true'
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
  fall | fall_too)
    [ "$act" = fall ] || first='"passed": false'
    passed=false end=fall code=1
    failures="{\"kind\": \"end\", \"place\": \"$path:1:1\", \"text\": \"the robot fell: torso 0.5 m, at 1.000 s in a\", \"at_s\": 1.0}" ;;
  drift)
    passed=false code=1
    failures="{\"kind\": \"golden\", \"place\": \"$path:9:9\", \"text\": \"leaves the golden trace: com.pos.z\", \"at_s\": 0.5}" ;;
  twice)
    passed=false code=1
    failures="{\"kind\": \"script\", \"place\": \"$path:10:5\", \"text\": \"the push never came\"}"
    first='"passed": false, "at_s": 0.6, "tick": 600, "state": "a", "why": "it was early"'
    second='"passed": false, "at_s": 5.5, "tick": 5500, "state": "b", "why": "it was late"' ;;
  unsaid) passed=false code=1 ;;
  slow) sleep 0.4 ;;
  fail)
    passed=false code=1
    first='"passed": false, "value": "0.25 rad", "at_s": 1.5, "tick": 1500, "state": "a", "why": "it was too much"' ;;
esac
list='' item=$first
while [ -n "$seen" ]; do
  list="$list${list:+, }{$item}" item=$second seen=${seen#?}
done
printf 'time,state,com.pos.z\n0.0,a,0.0\n0.5,a,%s\n' "$act" | sed 's/pass/0.5/; s/fail/0.5/; s/slow/0.7/; s/drift/0.7/' >"$folder/golden.csv"
echo "chatter before the result"
cat <<END
{"seed": $seed, "passed": $passed, "failures": [$failures], "expectations": [$list], "end": "$end", "coverage": {"states": ["machine", "a"], "transitions": [{"index": 0, "taken": $([ $((seed % 2)) = 1 ] && echo true || echo false)}], "guards": [{"index": 1, "true": false, "false": true}]}}
END
exit $code
