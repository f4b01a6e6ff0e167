/* Reset of a Cortex-A15 on QEMU's board `virt`: one stack, interrupts masked, memory made ready as on a Cortex-M. */
    .syntax unified
    .section .vectors, "ax"
    .global _start
_start:
    cpsid if
    ldr sp, =image_stack_top
    ldr r0, =image_bss_begin
    ldr r1, =image_bss_end
    mov r2, #0
1:  cmp r0, r1
    strlo r2, [r0], #4
    blo 1b
    bl firmware_main
2:  wfi
    b 2b
