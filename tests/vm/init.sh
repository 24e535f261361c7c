#!/bin/busybox sh
# First process of the guest: load the modules, mount the host read-only, run the job there, switch off.
b=/bin/busybox
$b mount -t proc proc /proc
$b mount -t sysfs sysfs /sys
$b mount -t devtmpfs dev /dev
for word in $($b cat /proc/cmdline); do
    case $word in
        root_of_tests=*) root=${word#*=} ;;
        python_of_tests=*) python=${word#*=} ;;
    esac
done
while read -r module; do $b insmod "/modules/$module"; done < /modules/order
$b mount -t 9p -o trans=virtio,version=9p2000.L,ro,msize=512000,cache=loose host /host
for directory in proc sys dev; do $b mount -o bind "/$directory" "/host/$directory"; done
$b mkdir -p /host/dev/pts && $b mount -t devpts devpts /host/dev/pts
for directory in run tmp; do $b mount -t tmpfs tmpfs "/host/$directory"; done
$b ip link set lo up
$b chroot /host /usr/bin/env -i PATH=/usr/local/sbin:/usr/sbin:/sbin:/usr/local/bin:/usr/bin:/bin HOME=/tmp \
    PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$root" "$python" -u "$root/tests/vm/job.py" || echo "VM TESTS FAILED"
$b poweroff -f
