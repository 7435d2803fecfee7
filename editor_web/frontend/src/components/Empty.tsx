/** What stands where there is nothing yet, and what to do about it. */
import { Stack, Text } from '@mantine/core'
import type { ReactNode } from 'react'

export function Empty({ icon, title, children }: { icon?: ReactNode; title: string; children?: ReactNode }) {
  return (
    <Stack align="center" justify="center" gap="4xs" p="lg" c="var(--quiet)" ta="center">
      {icon}
      <Text size="sm" fw={600} c="var(--text)">
        {title}
      </Text>
      {children && (
        <Text size="sm" maw="44ch">
          {children}
        </Text>
      )}
    </Stack>
  )
}
