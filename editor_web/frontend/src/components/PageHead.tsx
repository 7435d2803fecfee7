/** The head of a page: what it shows, and beside it what can be done there. */
import { Box, Flex, Group, Text, Title } from '@mantine/core'
import type { ReactNode } from 'react'

export interface PageHeadProps {
  readonly title: ReactNode
  /** One line about it. */
  readonly words?: ReactNode
  /** How it is, right after its name. */
  readonly state?: ReactNode
  /** Are the words read out when they change? */
  readonly isStatus?: boolean
  /** Does it stay in sight where its page scrolls? */
  readonly isSticky?: boolean
  readonly children?: ReactNode
}

const LINE = { borderBottom: '1px solid var(--line)' }
const STICKY = { pos: { base: 'static', md: 'sticky' }, top: 0, style: { ...LINE, zIndex: 4 } } as const

export function PageHead({ title, words, state, isStatus = false, isSticky = false, children }: PageHeadProps) {
  return (
    <Flex
      component="header"
      flex="none"
      align="center"
      gap={14}
      px={16}
      py="xs"
      bg="var(--surface)"
      wrap={{ base: 'wrap', md: 'nowrap' }}
      style={LINE}
      {...(isSticky ? STICKY : {})}
    >
      <Box miw={0} flex={{ base: '1 1 100%', md: '0 1 auto' }}>
        <Title order={1} fz="1.18rem" lh={1.25} style={{ overflow: 'hidden', textOverflow: 'ellipsis' }}>
          {title}
        </Title>
        {words && (
          <Text fz="0.84rem" c="var(--quiet)" lineClamp={2} {...(isStatus ? { role: 'status' } : {})}>
            {words}
          </Text>
        )}
      </Box>
      {state}
      <Group gap="xs" ml={{ base: 0, md: 'auto' }} flex="none" maw="100%">
        {children}
      </Group>
    </Flex>
  )
}
