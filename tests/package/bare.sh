#!/usr/bin/env bash
# Installs the Debian packages in a bare Debian 12, takes the first steps of a user there, and removes them. Needs root, the
# network, and debootstrap (Debian: debootstrap).
#   bare.sh DEBS SYSTEM      DEBS is what `scripts/package.sh --deb DEBS` wrote; SYSTEM is a folder, made unless it is there
set -euo pipefail
debs=$(realpath "$1") system=$(realpath -m "$2")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
[[ -e $system/usr/bin/apt-get ]] || debootstrap --variant=minbase bookworm "$system"
rm -rf "$system/packages" "$system/first-steps"
mkdir "$system/packages" "$system/first-steps"
cp "$debs"/*.deb "$system/packages/"
cp "$here/../sdk/extract.py" "$system/first-steps/"
cp /etc/resolv.conf "$system/etc/resolv.conf"

cat > "$system/first-steps/all.sh" << 'end'
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin
step() { echo "== $*"; }
apt-get update -qq
ours=(grit grit-dev grit-doc grit-mpi python3-grit)
for_the_plugin=(make libgtest-dev libgmock-dev) # what cmake and grit-dev recommend
remove() { apt-get purge -qq --autoremove "${ours[@]}" "${for_the_plugin[@]}" > /first-steps/purge.log 2>&1; }
! dpkg-query -W grit > /dev/null 2>&1 || remove # of a test that failed
apt-get install -qq --no-install-recommends man-db bash-completion > /dev/null
files() { find /usr /etc /opt /lib -xdev | LC_ALL=C sort; }
dpkg-query -W -f '${Package}\n' > /first-steps/packages-before

step install
apt-get install -qq --no-install-recommends /packages/*.deb "${for_the_plugin[@]}" > /first-steps/apt.log 2>&1 || { cat /first-steps/apt.log; exit 1; }
id user > /dev/null 2>&1 || useradd --create-home user
chown user /first-steps
cat > /first-steps/user.sh << 'user'
set -euo pipefail
cd /first-steps
step() { echo "== $*"; }
step version and plugins
grit --version
[[ $(grit plugins | grep -c '\.so$') -ge 30 ]]
step run
sed -n '/^```json box.json$/,/^```$/{//!p}' /usr/share/doc/grit/README.md > box.json
grit check box.json
grit run box.json --quiet
[[ -s results/box/report.html ]]
for level in /usr/lib/grit/*/; do
  GRIT_ISA=$(basename "$level") grit --version > /dev/null || [[ $? == 2 ]] # 2: this processor lacks it
done
step Python
python3 -c 'import grit
simulation = grit.Simulation("box.json")
simulation.run(until=0.01)
print(grit.__file__, simulation.bodies.position.shape)
print(grit.Run("results/box")) if hasattr(grit, "Run") else None'
step manual and completion
[[ $(man grit-run) == *--resume* ]]
[[ $(grit --help) == *"Documentation: /usr/share/doc/grit/docs"* ]]
man grit run > /dev/null
bash -ic 'source /usr/share/bash-completion/bash_completion; _completion_loader grit; COMP_WORDS=(grit ca) COMP_CWORD=1; _grit grit; [[ ${COMPREPLY[*]} == calibrate ]]' 2> /dev/null
step plugin
python3 extract.py plugins /usr/share/doc/grit/docs/plugins/*.md
compiler=$(sed -n 's/^set(grit_CXX_COMPILER "\(.*\)")/\1/p' /usr/lib/cmake/grit/*/grit-compiler.cmake | sort -u)
level=$(grit plugins | sed -n '1s/.*-march=\(.*\))/\1/p')
cmake -S plugins -B build -DCMAKE_CXX_COMPILER="$compiler" -DGRIT_ARCH="$level" -DCMAKE_BUILD_TYPE=Release > configure.log
cmake --build build --target contacts_adhesive > build.log || { cat build.log; exit 1; }
grit plugins adhesive --plugin-path build/lib/grit | head -n 3
user
chmod a+r /first-steps/*
command -v runuser > /dev/null && runuser -u user -- bash /first-steps/user.sh
python3 -c 'import grit' # by root, who could write into the folder of the module

step remove
remove
files > /first-steps/after
if grep grit /first-steps/after; then
  echo 'files of grit are left'
  exit 1
fi
dpkg-query -W -f '${Package}\n' | diff /first-steps/packages-before - || { echo 'packages are left'; exit 1; }
step all done
end
unshare --mount --fork bash -euo pipefail -c "
  mount --bind /proc '$system/proc'
  mount --rbind /dev '$system/dev'
  exec chroot '$system' bash /first-steps/all.sh"
