#!/usr/bin/env bash
# Runs tests/vm/job.py in a guest with Debian's kernel and real SocketCAN: vcan, two emulated controllers, slcand.
# Everything but the kernel is this machine's own, read-only. Needs no privileges and no image; see tests/vm/README.md.
#   tests/vm/run.sh KERNEL_DIR     an unpacked linux-image package (boot/ and lib/modules/)
set -euo pipefail
kernel_dir=$(realpath "${1:?unpacked linux-image package}")
root=$(realpath "$(dirname "$0")/../..")
python=$(realpath -s "${PYTHON:-$root/.venv/bin/python}") # its own name: what it links to is outside the environment
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
version=$(ls "$kernel_dir/lib/modules")
modules="virtio_pci 9pnet_virtio 9p can can-raw vcan slcan kvaser_pci"

depmod -b "$kernel_dir" "$version"
mkdir -p "$work"/initramfs/{bin,proc,sys,dev,host,modules}
cp "$(command -v busybox)" "$work/initramfs/bin/busybox"
# in the order in which they have to be loaded
# shellcheck disable=SC2086
modprobe -d "$kernel_dir" -S "$version" --show-depends -a $modules | awk '$1 == "insmod" {print $2}' | awk '!seen[$0]++' \
    | while read -r file; do
        cp "$file" "$work/initramfs/modules/"
        basename "$file" >> "$work/initramfs/modules/order"
    done
cp "$root/tests/vm/init.sh" "$work/initramfs/init"
chmod +x "$work/initramfs/init"
(cd "$work/initramfs" && find . | cpio -o -H newc --quiet | gzip -1) > "$work/initramfs.gz"

timeout "${VM_TIMEOUT_S:-600}" qemu-system-x86_64 -accel tcg -smp 2 -m 768 -nographic -nic none -no-reboot -monitor none \
    -kernel "$kernel_dir/boot/vmlinuz-$version" -initrd "$work/initramfs.gz" \
    -append "console=ttyS0 quiet panic=-1 root_of_tests=$root python_of_tests=$python" \
    -virtfs local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap \
    -object can-bus,id=bus -device kvaser_pci,canbus=bus -device kvaser_pci,canbus=bus \
    < /dev/null | stdbuf -oL tr -d '\r' | tee "$work/console"
grep -q "^VM TESTS PASSED" "$work/console"
