# The vector table: EBase + 0x200 + 32 x vector (section 5; IntCtl.VS = 1). Each slot passes the handler's address in k0,
# which compiled code never uses, and enters by a symbol of its own, which is __interrupt_entry unless the program has
# another one (see interrupt/mod.rs).

    .macro slot handler
    .balign 32
    lui     $k0, %hi(\handler)
    j       __enter_\handler
    addiu   $k0, $k0, %lo(\handler)
    .endm

    .macro spare
    .balign 32
    lui     $k0, %hi(__unhandled_interrupt)
    j       __interrupt_entry
    addiu   $k0, $k0, %lo(__unhandled_interrupt)
    .endm

    .section .vectors.interrupts, "ax"
    slot CORE_TIMER
    slot CORE_SOFTWARE_0
    slot CORE_SOFTWARE_1
    slot EXTERNAL_0
    slot TIMER_1
    slot INPUT_CAPTURE_1
    slot OUTPUT_COMPARE_1
    slot EXTERNAL_1
    slot TIMER_2
    slot INPUT_CAPTURE_2
    slot OUTPUT_COMPARE_2
    slot EXTERNAL_2
    slot TIMER_3
    slot INPUT_CAPTURE_3
    slot OUTPUT_COMPARE_3
    slot EXTERNAL_3
    slot TIMER_4
    slot INPUT_CAPTURE_4
    slot OUTPUT_COMPARE_4
    slot EXTERNAL_4
    slot TIMER_5
    slot INPUT_CAPTURE_5
    slot OUTPUT_COMPARE_5
    slot SPI_1
    slot UART_1
    slot I2C_1
    slot CHANGE_NOTICE
    slot ADC
    slot PARALLEL_PORT
    slot COMPARATOR_1
    slot COMPARATOR_2
    slot SPI_2
    slot UART_2
    slot I2C_2
    slot CLOCK_MONITOR
    slot CALENDAR
    slot DMA_0
    slot DMA_1
    slot DMA_2
    slot DMA_3
    spare
    spare
    spare
    spare
    slot FLASH
