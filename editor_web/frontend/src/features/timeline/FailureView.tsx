/** How a run failed: the innermost cause, what was measured, what can be done, and what differs from the last good run. */
import { Alert, Box, Button, Flex, SimpleGrid, Text, Title } from '@mantine/core'
import { IconCircleCheck, IconCircleX, IconHistory } from '@tabler/icons-react'
import type { ReactNode } from 'react'
import { seekEvent } from '../../api/timeline'
import type { RunFailure, RunView } from '../../api/types'
import { Empty } from '../../components/Empty'
import { Panel } from '../../components/Panel'
import { reportOf } from '../../document/failure'
import { isActive } from '../../document/runState'
import { FailureActions, type FailurePage } from './FailureActions'
import { Around, Causes, LastGood, Measured, Steps, type At } from './FailureParts'
import { useFailure, useLastGoodRun } from './useFailure'
import { useSubject } from './useSubject'

export interface FailureViewProps {
  readonly run: RunView | undefined
  readonly page: FailurePage
  readonly onShow: (path: string) => void
}

export function FailureView({ run, page, onShow }: FailureViewProps) {
  const subject = useSubject(run)
  const isOver = run !== undefined && !isActive(run)
  const { failure, problem } = useFailure(subject, isOver)

  function show(at: At): void {
    if (subject) seekEvent(subject, at)
    if (at.path) onShow(at.path)
  }

  return (
    <Panel title="Failure" tools={failure && subject && <Tools failure={failure} onShow={show} />}>
      {failure && run ? (
        <FailureText run={run} failure={failure} page={page} onShow={show} />
      ) : (
        <Empty icon={<IconCircleCheck size={26} stroke={1.4} aria-hidden />} title={problem || emptyTitle(run, isOver, failure)}>
          When a run fails, this tab tells where it began, why, and what to do.
        </Empty>
      )}
    </Panel>
  )
}

function Tools({ failure, onShow }: { failure: RunFailure; onShow: (at: At) => void }) {
  return (
    <>
      <Text span size="sm" c="dimmed" truncate>
        {failure.path ? `It began in ${failure.path}` : 'It began in the run itself'} at {failure.time_s.toFixed(2)} s
      </Text>
      <Button
        variant="light"
        size="compact-sm"
        ml="auto"
        flex="none"
        leftSection={<IconHistory size={15} aria-hidden />}
        onClick={() => onShow(failure)}
      >
        Show the moment
      </Button>
    </>
  )
}

function emptyTitle(run: RunView | undefined, isOver: boolean, failure: RunFailure | null | undefined): string {
  if (!run) return 'No run yet'
  if (!isOver) return 'The run is active'
  return failure === undefined ? 'Reading…' : 'This run did not fail'
}

interface FailureTextProps {
  readonly run: RunView
  readonly failure: RunFailure
  readonly page: FailurePage
  readonly onShow: (at: At) => void
}

function FailureText({ run, failure, page, onShow }: FailureTextProps) {
  const comparison = useLastGoodRun(run.id, true)
  const { links, steps, around, hint } = failure
  const measured = links.flatMap((link) => link.compared)
  const report = reportOf(run, failure, comparison ?? undefined, location.href)
  return (
    <Flex pos="absolute" inset={0} direction="column">
      <Box
        flex={1}
        mih={0}
        px="md"
        pt="xs"
        style={{ overflow: 'auto', overflowWrap: 'anywhere' }}
        tabIndex={0}
        role="region"
        aria-label="How the run failed"
      >
        <Flex gap="sm">
          <IconCircleX size={19} color="var(--failed)" style={{ flex: 'none', marginTop: 2 }} aria-hidden />
          <Title order={3} size="md">
            {failure.text}
          </Title>
        </Flex>
        {hint && (
          <Alert role="note" p="xs" my="xs">
            <strong>What to do: </strong>
            {hint}
          </Alert>
        )}
        <SimpleGrid minColWidth="min(100%, 17rem)" autoFlow="auto-fit" spacing="xl" verticalSpacing="xs">
          {measured.length > 0 && (
            <Section title="Expected against measured">
              <Measured values={measured} />
            </Section>
          )}
          {links.length > 0 && (
            <Section title="Why">
              <Causes links={links} />
            </Section>
          )}
          {steps.length > 0 && (
            <Section title="Where">
              <Steps failure={failure} onShow={onShow} />
            </Section>
          )}
          <Section title="Against the last good run">
            <LastGood comparison={comparison} />
          </Section>
          {around.length > 0 && (
            <Section title="What happened there">
              <Around lines={around} onShow={onShow} />
            </Section>
          )}
        </SimpleGrid>
      </Box>
      {/* Below what scrolls: what can be done is in sight, however low the panel is. */}
      <Box px="md" py={4} style={{ borderTop: '1px solid var(--line)' }}>
        <FailureActions {...page} run={run} failure={failure} report={report} />
      </Box>
    </Flex>
  )
}

function Section({ title, children }: { readonly title: string; readonly children: ReactNode }) {
  return (
    <section>
      <Title order={4} size="sm" my={4}>
        {title}
      </Title>
      {children}
    </section>
  )
}
