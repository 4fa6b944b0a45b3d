# What zsh shows for PROGRAM of PREFIX after "--" and a tab: its long options.
# usage: zsh -f completed.zsh PREFIX PROGRAM
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "PATH=$1/bin:\$PATH fpath=($1/share/zsh/site-functions \$fpath); autoload -Uz compinit; compinit -u -D; stty cols 250 rows 200; print rea''dy"
zpty -r -m shell line '*ready*'
zpty -w -n shell "$2 --"$'\t\t'
zpty -r -m shell line '*--version*'
print -r -- "$line"
sleep 1
while zpty -r -t shell line; do print -r -- "$line"; done
zpty -d shell
