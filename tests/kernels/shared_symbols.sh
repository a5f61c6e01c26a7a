#!/bin/sh
# shared_symbols.sh NM OBJECT...
# Fails if an object compiled for a wide instruction set defines a symbol outside its own namespace or a weak one:
# the linker could keep that copy for the whole program.
nm=$1
shift
[ $# -gt 0 ] || { echo "no objects given"; exit 1; }
for object in "$@"; do
  symbols=$("$nm" -C --defined-only --extern-only "$object") || exit 1
  [ -n "$symbols" ] || { echo "$object defines nothing"; exit 1; }
  foreign=$(echo "$symbols" | grep -v ' T palpate::kernels::v[34]::')
  [ -z "$foreign" ] || { echo "$object defines $foreign"; exit 1; }
done
