# Completion of grit for bash. 'grit --complete WORD…' prints what may follow: core/src/app/completion.hpp.
_grit() {
  local current=${COMP_WORDS[COMP_CWORD]} words=() names=() i line folder
  [[ $current == = ]] && current=''
  current=${current//\\/} # readline quotes spaces
  for ((i = 1; i <= COMP_CWORD; ++i)); do
    # Readline makes three words of --out=results.
    if [[ ${#words[@]} != 0 && (${COMP_WORDS[i]} == = || ${words[-1]} == *=) ]]; then
      words[-1]+=${COMP_WORDS[i]}
    else
      words+=("${COMP_WORDS[i]}")
    fi
  done

  COMPREPLY=()
  while IFS= read -r line; do
    case $line in
      ':files '*)
        compopt -o filenames
        mapfile -t COMPREPLY < <(compgen -o plusdirs -f -X "!${line#:files }" -- "$current")
        ;;
      :folders)
        compopt -o filenames
        mapfile -t COMPREPLY < <(compgen -d -- "$current")
        ;;
      :results)
        compopt -o filenames
        while IFS= read -r folder; do
          [[ -z $(find -L "$folder" -maxdepth 3 -name run.json -print -quit 2> /dev/null) ]] || COMPREPLY+=("$folder")
        done < <(compgen -d -- "$current")
        ;;
      *) names+=("${line%%$'\t'*}") ;;
    esac
  done < <("$1" --complete "${words[@]}" 2> /dev/null)
  [[ ${#names[@]} == 0 ]] || mapfile -t COMPREPLY < <(compgen -W "${names[*]}" -- "$current")
}
complete -F _grit grit
