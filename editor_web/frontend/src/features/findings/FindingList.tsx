/** The problems of a document, with place and advice. */
import { Divider, Group, Text, VisuallyHidden } from '@mantine/core'
import { IconCircleCheck } from '@tabler/icons-react'
import type { FindingView } from '../../api/types'
import { Empty } from '../../components/Empty'
import { StatusIcon } from '../../components/StatusIcon'
import { TextButton } from '../../components/TextButton'
import { Words } from '../../components/Words'
import { statusOf } from '../../document/runState'
import { nameOfPath } from '../../document/path'

export interface FindingListProps {
  readonly document: string
  readonly findings: readonly FindingView[]
  readonly onSelect: (path: string) => void
}

export function FindingList({ document, findings, onSelect }: FindingListProps) {
  if (findings.length === 0) {
    return (
      <Empty icon={<IconCircleCheck size={26} stroke={1.4} aria-hidden />} title="No problems">
        The document can be run.
      </Empty>
    )
  }
  return (
    <ul className="plain-list">
      {findings.map((finding, index) => (
        <li key={index} data-finding={finding.code}>
          {index > 0 && <Divider />}
          <Group gap="xs" py="2xs" wrap="nowrap" align="flex-start">
            <StatusIcon status={statusOf(finding.severity)} size={16} />
            <div>
              <VisuallyHidden component="span">{finding.severity}: </VisuallyHidden>
              <Words text={finding.message} />
              {finding.hint && (
                <Text size="sm" c="var(--quiet)">
                  <Words text={finding.hint} />
                </Text>
              )}
              <Group gap="2xs" mt={3} fz="xs" ff="monospace" c="var(--quiet)">
                {nameOfPath(document)}:{finding.line}:{finding.column} · {finding.code}
                {finding.path && (
                  <TextButton label={`${finding.path}: ${finding.message}`} onPress={() => onSelect(finding.path)}>
                    {finding.path}
                  </TextButton>
                )}
              </Group>
            </div>
          </Group>
        </li>
      ))}
    </ul>
  )
}
