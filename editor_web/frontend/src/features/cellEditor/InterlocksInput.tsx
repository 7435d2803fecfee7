/** Positions of a device that are left alone unless another device is at one of its own. */
import { ActionIcon, Button, Group, NativeSelect, Stack } from '@mantine/core'
import { IconPlus, IconX } from '@tabler/icons-react'
import { listOf } from '../../document/cellDevices'
import { wordsOf, type Field } from '../../document/cellFields'
import { lookup, type Dict } from '../../document/dict'

interface InterlocksInputProps {
  readonly field: Field & { readonly kind: 'interlocks' }
  readonly value: unknown
  readonly onChange: (value: unknown) => void
}

export function InterlocksInput({ field, value, onChange }: InterlocksInputProps) {
  const { own, others } = field
  const locks = listOf(value)
  const write = (next: readonly Dict<unknown>[]) => onChange(next.length === 0 ? undefined : next)
  const change = (at: number, lock: Dict<unknown>) => write(locks.map((each, index) => (index === at ? lock : each)))
  const device = Object.keys(others)[0]
  return (
    <Stack gap={6} role="group" aria-label={field.label}>
      {locks.map((lock, at) => {
        const name = wordsOf(lookup(lock, 'device'))
        const row = (key: 'position' | 'device' | 'at', words: string, choices: readonly string[]) => {
          const now = wordsOf(lookup(lock, key))
          return (
            <NativeSelect
              size="xs"
              flex={1}
              miw={0}
              aria-label={`${words} of interlock ${at + 1}`}
              value={now}
              data={[...new Set([now, ...choices])]}
              onChange={(event) => change(at, { ...lock, [key]: event.currentTarget.value })}
            />
          )
        }
        return (
          // Interlocks have no names: their order is what they are.
          <Group key={at} gap={4} wrap="nowrap">
            {row('position', 'Position', own)}
            {row('device', 'Other device', Object.keys(others))}
            {row('at', 'Its position', lookup(others, name) ?? [])}
            <ActionIcon
              variant="subtle"
              color="gray"
              aria-label={`Remove interlock ${at + 1}`}
              onClick={() => write(locks.filter((_, index) => index !== at))}
            >
              <IconX size={14} aria-hidden />
            </ActionIcon>
          </Group>
        )
      })}
      <Button
        size="compact-xs"
        variant="default"
        w="fit-content"
        leftSection={<IconPlus size={13} aria-hidden />}
        disabled={device === undefined || own.length === 0}
        onClick={() => write([...locks, { position: own[0] ?? '', device: device ?? '', at: lookup(others, device ?? '')?.[0] ?? '' }])}
      >
        Interlock
      </Button>
    </Stack>
  )
}
