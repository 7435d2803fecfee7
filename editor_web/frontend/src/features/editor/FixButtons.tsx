/** What would fix a problem, each to be chosen; and the problems of one node in its form. */
import { Box, Button, Group, UnstyledButton, VisuallyHidden } from '@mantine/core'
import { IconBulb } from '@tabler/icons-react'
import type { Fix } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { problemsOf } from '../../document/editing/findings'
import { statusOf } from '../../document/runState'
import { Words } from '../../components/Words'
import { makeFix } from './fixes'
import { goTo } from './problems'
import { PlainList } from './PlainList'
import rows from './row.module.css'
import { draftOf, useEditor } from './store'

export function FixButtons({ fixes }: { fixes: readonly Fix[] }) {
  if (fixes.length === 0) return null
  return (
    <Group gap={5} mt={5} role="group" aria-label="Fixes">
      {fixes.map((fix) => (
        <Button
          key={fix.title}
          size="compact-xs"
          variant="default"
          radius="xl"
          h="auto"
          mih={26}
          py={2}
          styles={{ label: { whiteSpace: 'normal' } }}
          leftSection={<IconBulb size={13} color="var(--stopped)" aria-hidden />}
          onClick={() => makeFix(fix)}
        >
          <span>
            <Words text={fix.title} />
          </span>
        </Button>
      ))}
    </Group>
  )
}

/** Over the form of a node: a line each, which leads to the list of problems with its fixes. */
export function NodeFindings({ path }: { path: string }) {
  const findings = useEditor((s) => problemsOf(draftOf(s)))
  const own = findings.filter((finding) => finding.path === path)
  if (own.length === 0) return null
  return (
    <Box px="xs" bg="var(--canvas)">
      <PlainList label="Problems of this node">
        {own.map((finding, index) => (
          <li key={index}>
            <UnstyledButton
              className={`${rows['row']} pick-row`}
              title={`${finding.message}. Show it with its fixes`}
              onClick={() => goTo(finding)}
            >
              <StatusIcon status={statusOf(finding.severity)} size={15} />
              <span className={rows['line']}>
                <VisuallyHidden>{finding.severity}: </VisuallyHidden>
                <Words text={finding.message} />
              </span>
            </UnstyledButton>
          </li>
        ))}
      </PlainList>
    </Box>
  )
}
