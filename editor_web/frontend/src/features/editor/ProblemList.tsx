/** The problems of the draft, with place and advice; each leads to its node and line. */
import { Box, NativeSelect, Stack, Text, UnstyledButton, VisuallyHidden } from '@mantine/core'
import { IconCircleCheck, IconCircleDashed } from '@tabler/icons-react'
import type { FindingView, Fix } from '../../api/types'
import { Empty } from '../../components/Empty'
import { StatusIcon } from '../../components/StatusIcon'
import { unfinishedWords, problemsOf } from '../../document/editing/findings'
import { statusOf } from '../../document/runState'
import { Words } from '../../components/Words'
import { FixButtons } from './FixButtons'
import { fixesOf, useFreshFixes } from './fixes'
import { FormWords } from './FormParts'
import { PlainList } from './PlainList'
import rows from './row.module.css'
import { goTo } from './problems'
import { draftOf, setEditor, useEditor } from './store'
import { setTargetLevel, useTargets, type TargetLevel } from './targets'

export function ProblemList() {
  return (
    <>
      <Problems />
      <TargetChoice />
    </>
  )
}

/** What targets count as that an arm cannot be at, and why they are not known. */
function TargetChoice() {
  const { level, problem } = useTargets()
  return (
    <Box mt="sm">
      <NativeSelect
        size="xs"
        label="Targets out of reach or in collision"
        value={level}
        data={[
          { value: 'warning', label: 'are warnings' },
          { value: 'error', label: 'are errors' },
          { value: 'off', label: 'are not looked for' },
        ]}
        onChange={(event) => setTargetLevel(event.currentTarget.value as TargetLevel)}
      />
      {problem && <FormWords>{problem}</FormWords>}
    </Box>
  )
}

function Problems() {
  const findings = useEditor((s) => problemsOf(draftOf(s)))
  const unfinished = useEditor((s) => unfinishedWords(draftOf(s).root))
  const fixes = useFreshFixes()
  if (findings.length === 0) {
    return unfinished ? (
      <Empty icon={<IconCircleDashed size={26} stroke={1.4} aria-hidden />} title="Not finished">
        {unfinished}
      </Empty>
    ) : (
      <Empty icon={<IconCircleCheck size={26} stroke={1.4} aria-hidden />} title="No problems">
        The behavior can be run.
      </Empty>
    )
  }
  return (
    <PlainList label="Problems">
      {findings.map((finding) => (
        <Problem key={keyOf(finding)} finding={finding} fixes={fixesOf(fixes, finding)} />
      ))}
    </PlainList>
  )
}

function keyOf({ line, column, code, path, message }: FindingView): string {
  return [line, column, code, path, message].join(' ')
}

/** One line, which leads to its node and unfolds advice, place and fixes. */
function Problem({ finding, fixes }: { readonly finding: FindingView; readonly fixes: readonly Fix[] }) {
  const place = useEditor((s) => s.place)
  const isOpen = place?.line === finding.line && place.column === finding.column
  return (
    <li>
      <UnstyledButton
        className={`${rows['row']} pick-row`}
        aria-expanded={isOpen}
        onClick={() => (isOpen ? setEditor({ place: undefined }) : goTo(finding))}
      >
        <StatusIcon status={statusOf(finding.severity)} size={16} />
        <span className={rows['line']}>
          <VisuallyHidden>{finding.severity}: </VisuallyHidden>
          <Words text={finding.message} />
        </span>
        <Text span size="xs" c="dimmed" flex="none" mt={2}>
          line {finding.line}
        </Text>
      </UnstyledButton>
      {isOpen && (
        <Stack gap={4} pl={32} pr={6} pb={8}>
          {finding.hint && <FormWords>{finding.hint}</FormWords>}
          <Text size="xs" c="dimmed" ff="monospace">
            {finding.path || 'document'} · {finding.code}
          </Text>
          <FixButtons fixes={fixes} />
        </Stack>
      )}
    </li>
  )
}
